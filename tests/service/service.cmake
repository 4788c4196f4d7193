# Debian's, which has numpy and selenium
find_program(DEBIAN_PYTHON3 python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)

# service_test(NAME ARGUMENTS…): a Python test against `lumulus serve`.
function(service_test name)
  add_test(NAME service.${name} COMMAND ${DEBIAN_PYTHON3} -B ${ARGN} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR}/tests/service)
  set(environment "LUMULUS=$<TARGET_FILE:lumulus>")
  if(LUMULUS_SANITIZE)
    # what AddressSanitizer keeps of freed memory (256 MB by itself) looks to tests as if the server grew
    list(APPEND environment "ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1:quarantine_size_mb=8")
  endif()
  set_tests_properties(service.${name} PROPERTIES TIMEOUT 300 ENVIRONMENT "${environment}")
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
foreach(class Page Failures First Death Phone)
  service_test(page.${class} page_test.py ${class})
endforeach()
foreach(class Files Token)
  service_test(page.${class} page_files_test.py ${class})
endforeach()
service_test(scenes scenes_test.py)
service_test(examples examples_test.py)
service_test(tls tls_test.py)
service_test(client client_test.py ${CMAKE_BINARY_DIR} $<$<BOOL:${LUMULUS_SANITIZE}>:-fsanitize=address,undefined>)
# 60 s: /usr/bin/python3 tests/service/load_test.py --seconds 60
service_test(load load_test.py --seconds 15)
# What waits for deadlines, shares and a browser has the machine for itself.
set_tests_properties(service.load service.frames.Behaviour service.page.Page service.page.Failures service.page.First
                     service.page.Death service.page.Phone service.page.Files service.page.Token PROPERTIES RUN_SERIAL TRUE)
