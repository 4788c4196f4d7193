lumulus_test(progressive_noise_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/progressive_noise_test.cpp
             LINK lumulus_progressive)
