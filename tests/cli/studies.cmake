# The scripts that measure take minutes to an hour: here the smallest that makes them run. Those that need packages
# beyond scripts/install_packages.sh are left out.
set(tiny --lumulus $<TARGET_FILE:lumulus> --width 32 --set cloud.0.resolution=24 --set photon_map.photons=4000
         --set preparation.samples=500)
function(lumulus_study name script)
  add_test(NAME studies.${name} COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/scripts/${script}.py ${tiny} ${ARGN})
  set_tests_properties(studies.${name} PROPERTIES TIMEOUT 300)
endfunction()
find_package(Python3 REQUIRED COMPONENTS Interpreter)
lumulus_study(scores scores --scenes cirrus --spp 2)
lumulus_study(unseen scores --unseen --scenes stratus-low-sun --spp 2)
lumulus_study(scaling scaling --resolutions 24 --collectors 200 --photons 1000)
