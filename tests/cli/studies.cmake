# lumulus_study(NAME STUDY WORDS…): a study of scripts/study runs to its end with exit code 0.
function(lumulus_study name study)
  add_test(NAME ${name} COMMAND ${DEBIAN_PYTHON3} ${CMAKE_SOURCE_DIR}/scripts/study/run ${study} ${ARGN}
                                --lumulus $<TARGET_FILE:lumulus>)
  set_tests_properties(${name} PROPERTIES TIMEOUT 300)
endfunction()

# Those that measure take minutes to an hour: here in the smallest form.
set(tiny --width 32 --set cloud.0.resolution=24 --set photon_map.photons=4000 --set preparation.samples=500)
lumulus_study(studies.scores scores ${tiny} --scenes cirrus --spp 2)
lumulus_study(studies.unseen scores ${tiny} --unseen --scenes stratus-low-sun --spp 2)
lumulus_study(studies.many_clouds many_clouds ${tiny} --numbers 1 3 --resolution 24 --photons 2000 --compare 3)
lumulus_study(studies.many_clouds_truth many_clouds_truth --width 32 --scenes overlap --spp 2 --photons 2000
              --set cloud.0.resolution=24 --set preparation.samples=500)
lumulus_study(studies.scaling scaling ${tiny} --resolutions 24 --collectors 200 --photons 1000)
lumulus_study(studies.bias_table bias_table ${tiny} --scenes smoke --spp 2 --fewer 1000)
lumulus_study(studies.proven_error proven_error ${tiny} --scenes smoke --seeds 2 --paths 1000 --spp 2)
lumulus_study(studies.flat_voxels flat_voxels --spp 2 --set photon_map.photons=1000 --set photon_map.generations=2
              --set preparation.samples=500 --set cloud.0.resolution=16)
lumulus_study(studies.backward_peak backward_peak --g -0.95 --views "from the side" --quality draft --spp 2
              --set photon_map.photons=1000 --set preparation.samples=500 --set cloud.0.resolution=16)
lumulus_study(studies.sequence sequence --width 32 --frames 3 --photons 4000 --alone 2 --kills 2
              --set preparation.samples=100)
lumulus_study(studies.colour_specks colour_specks ${tiny} --scenes smoke many --seeds 2)
lumulus_study(studies.contact_sheet contact_sheet ${tiny} --scenes cirrus --spp 2 -o ${CMAKE_BINARY_DIR}/contact-sheet.png)
lumulus_study(studies.hostile hostile --only "no HTTP" --seconds 1)
add_test(NAME studies.tools COMMAND ${DEBIAN_PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/studies_test.py $<TARGET_FILE:lumulus>)
set_tests_properties(studies.tools PROPERTIES TIMEOUT 300)

# Those whose answer is known judge themselves: ctest -L known-answer
lumulus_study(known.published_layers slab_table ${CMAKE_CURRENT_LIST_DIR}/published_layers.csv --photons 100000 --seeds 2)
lumulus_study(known.random_layers slab_table --random 3 --photons 20000 --seeds 2)
foreach(group Layers furnace Fog)
  string(TOLOWER ${group} name)
  lumulus_study(known.stiff_${name} stability --only ${group} --output ${CMAKE_BINARY_DIR}/stability-${name}.md
                --fixtures $<TARGET_FILE:make_vdb_fixtures>)
endforeach()
set_tests_properties(known.published_layers known.random_layers known.stiff_layers known.stiff_furnace known.stiff_fog
                     PROPERTIES LABELS known-answer)
# Their cases have limits of time of their own, on all cores.
set_tests_properties(known.stiff_layers known.stiff_furnace known.stiff_fog PROPERTIES RUN_SERIAL TRUE)
lumulus_study(studies.sky_journeys sky_journeys --width 32 --frames 2 2 --photons 4000 --set cloud.0.resolution=16
              -o ${CMAKE_BINARY_DIR}/journeys)
lumulus_study(studies.deforming deforming --width 32 --frames 3 --resolution 16 --photons 1000 --truth 4 --samples 500
              --means 8)
