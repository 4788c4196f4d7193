find_package(Python3 REQUIRED COMPONENTS Interpreter)

# service_test(NAME ARGUMENTS…): a Python test against `lumulus serve`.
function(service_test name)
  add_test(NAME service.${name} COMMAND ${Python3_EXECUTABLE} ${ARGN} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR}/tests/service)
  set_tests_properties(service.${name} PROPERTIES TIMEOUT 300 ENVIRONMENT "LUMULUS=$<TARGET_FILE:lumulus>")
endfunction()

foreach(class Equality Behaviour Ending)
  service_test(frames.${class} frames_test.py ${class})
endforeach()
foreach(class Hostile Binding)
  service_test(hostile.${class} hostile_test.py ${class})
endforeach()
foreach(class Faults FullDisk Restart)
  service_test(faults.${class} faults_test.py ${class})
endforeach()
foreach(class Page Phone)
  service_test(page.${class} page_test.py ${class})
endforeach()
service_test(tls tls_test.py)
# 60 s: python3 tests/service/load_test.py --seconds 60
service_test(load load_test.py --seconds 15)
