# OpenGL loader, generated at configure time from the specification that the package carries (no network).
find_program(POSTFX_GLAD glad REQUIRED)
set(glad_dir ${CMAKE_BINARY_DIR}/glad)
if(NOT EXISTS ${glad_dir}/src/gl.c)
  message(STATUS "Generating the OpenGL loader with glad")
  execute_process(
    COMMAND ${POSTFX_GLAD} --reproducible --quiet --api gl:core=4.5 --extensions GL_KHR_debug,GL_KHR_parallel_shader_compile
            --out-path ${glad_dir} c
    RESULT_VARIABLE glad_failed)
  if(glad_failed)
    message(FATAL_ERROR "glad could not generate the OpenGL loader (package python3-glad)")
  endif()
endif()
add_library(postfx_glad STATIC ${glad_dir}/src/gl.c)
target_include_directories(postfx_glad SYSTEM PUBLIC ${glad_dir}/include)
