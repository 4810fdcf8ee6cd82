# OpenGL loader, generated at configure time from the specification that the package carries (no network). Its names get
# a prefix and its header a folder of their own, so that the library can be linked beside a program's own glad.
find_program(POSTFX_GLAD glad REQUIRED)
set(glad_dir ${CMAKE_BINARY_DIR}/postfx_glad)
if(NOT EXISTS ${glad_dir}/src/gl.c)
  message(STATUS "Generating the OpenGL loader with glad")
  execute_process(
    COMMAND ${POSTFX_GLAD} --reproducible --quiet --api gl:core=4.5 --extensions GL_KHR_debug,GL_KHR_parallel_shader_compile
            --out-path ${glad_dir}/generated c
    RESULT_VARIABLE glad_failed)
  if(glad_failed)
    message(FATAL_ERROR "glad could not generate the OpenGL loader (package python3-glad)")
  endif()
  foreach(file include/KHR/khrplatform.h include/glad/gl.h src/gl.c)
    file(READ ${glad_dir}/generated/${file} text)
    string(REPLACE "glad_" "postfx_glad_" text "${text}")
    string(REPLACE "gladLoad" "postfx_glad_load" text "${text}")
    string(REPLACE "GLAD_GL_" "POSTFX_GLAD_GL_" text "${text}")
    string(REGEX REPLACE "<(KHR|glad)/" "<postfx_glad/" text "${text}")
    string(REGEX REPLACE "^include/(KHR|glad)/" "include/postfx_glad/" file ${file})
    file(WRITE ${glad_dir}/${file} "${text}")
  endforeach()
endif()
add_library(postfx_glad STATIC ${glad_dir}/src/gl.c)
set_target_properties(postfx_glad PROPERTIES C_VISIBILITY_PRESET hidden)
target_include_directories(postfx_glad SYSTEM PUBLIC ${glad_dir}/include)
