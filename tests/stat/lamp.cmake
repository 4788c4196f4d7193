lumulus_test(lamp_picture_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/lamp_picture_test.cpp
             LINK lumulus_lamp lumulus_reference)
lumulus_test(lamp_cloud_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/lamp_cloud_test.cpp
             LINK lumulus_lamp lumulus_reference lumulus_volume)
