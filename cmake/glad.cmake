# OpenGL loader, generated at configure time from the specification that the package carries (no network).
find_program(POSTFX_GLAD glad REQUIRED)
set(glad_dir ${CMAKE_BINARY_DIR}/glad)
if(NOT EXISTS ${glad_dir}/src/gl.c)
  message(STATUS "Generating the OpenGL loader with glad")
  execute_process(
    COMMAND ${POSTFX_GLAD} --reproducible --quiet --api gl:core=4.5,egl=1.5
            --extensions GL_KHR_debug,GL_KHR_parallel_shader_compile,EGL_EXT_platform_base,EGL_EXT_device_base,EGL_EXT_device_enumeration,EGL_EXT_device_query,EGL_EXT_device_drm,EGL_EXT_platform_device,EGL_MESA_platform_surfaceless,EGL_KHR_create_context,EGL_KHR_no_config_context,EGL_KHR_surfaceless_context
            --out-path ${glad_dir} c
    RESULT_VARIABLE glad_failed)
  if(glad_failed)
    message(FATAL_ERROR "glad could not generate the OpenGL loader (package python3-glad)")
  endif()
endif()
add_library(postfx_glad STATIC ${glad_dir}/src/gl.c ${glad_dir}/src/egl.c)
target_include_directories(postfx_glad SYSTEM PUBLIC ${glad_dir}/include)
target_link_libraries(postfx_glad PRIVATE ${CMAKE_DL_LIBS})
