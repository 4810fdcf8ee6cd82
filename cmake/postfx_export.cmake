# What others build against: find_package(postfx) finds the build tree (-Dpostfx_DIR=<build>) or an installation
# (<prefix>/lib/cmake/postfx) and provides
#   postfx_add_effect(), postfx_warnings()
#   postfx::plugin_headers   what an effect needs: headers only
#   postfx::postfx           the embedding library
#   postfx::testing          the harness of effects' tests, and
#   postfx::gl_test_main     its main()
#   postfx_PLUGIN_DIR        the folder of the effects that came with it
include(CMakePackageConfigHelpers)

set(config_dir lib/cmake/postfx)
set(libraries postfx postfx_glad postfx_base postfx_image postfx_gl postfx_plugin postfx_chain postfx_plan
              postfx_report postfx_budget postfx_execute postfx_testing postfx_gl_test_main)

# Inside the tree targets see its folders; to others they show the public headers.
function(postfx_set_installed_headers target directory)
  foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
    get_target_property(own ${target} ${property})
    if(own)
      set_target_properties(${target} PROPERTIES
        ${property} "$<BUILD_INTERFACE:${own}>;$<INSTALL_INTERFACE:${directory}>")
    endif()
  endforeach()
endfunction()

foreach(target ${libraries} postfx_plugin_headers)
  string(REGEX REPLACE "^postfx_" "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  if(NOT target MATCHES "^postfx_(testing|gl_test_main)$")
    postfx_set_installed_headers(${target} include)
  endif()
endforeach()
postfx_set_installed_headers(postfx_testing "include;include/postfx_testing")
install(DIRECTORY tests/harness/ DESTINATION include/postfx_testing FILES_MATCHING PATTERN "*.hpp")

# Two exports, because an effect can be built on a machine that has none of the library's dependencies.
install(TARGETS postfx_plugin_headers EXPORT postfx-plugin-targets)
install(TARGETS ${libraries} EXPORT postfx-library-targets ARCHIVE DESTINATION lib)
foreach(export postfx-plugin-targets postfx-library-targets)
  export(EXPORT ${export} NAMESPACE postfx:: FILE ${PROJECT_BINARY_DIR}/${export}.cmake)
  install(EXPORT ${export} NAMESPACE postfx:: DESTINATION ${config_dir})
endforeach()

# Everything that `cmake --install` copies and that effects elsewhere link with: what ./run builds.
add_custom_target(postfx_installed)
add_dependencies(postfx_installed postfx_program postfx_effects ${libraries})

set(POSTFX_LIBRARY_DEPENDENCIES "fmt OpenEXR yaml-cpp nlohmann_json OpenGL Catch2")
file(STRINGS framework/include/postfx/plugin.h abi_major REGEX "^#define POSTFX_ABI_MAJOR ")
string(REGEX REPLACE "[^0-9]" "" abi_major ${abi_major})
# The same file for both; only the places of our CMake functions and of the plugins differ.
set(POSTFX_FUNCTIONS_DIR ${PROJECT_SOURCE_DIR}/cmake)
set(POSTFX_PLUGINS ${PROJECT_BINARY_DIR}/postfx_plugins)
configure_file(cmake/postfx-config.cmake.in ${PROJECT_BINARY_DIR}/postfx-config.cmake @ONLY)
set(POSTFX_FUNCTIONS_DIR "\${CMAKE_CURRENT_LIST_DIR}")
set(POSTFX_PLUGINS "\${CMAKE_CURRENT_LIST_DIR}/../../postfx/plugins-${abi_major}")
configure_file(cmake/postfx-config.cmake.in ${PROJECT_BINARY_DIR}/installed/postfx-config.cmake @ONLY)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/postfx-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/installed/postfx-config.cmake ${PROJECT_BINARY_DIR}/postfx-config-version.cmake
              cmake/postfx_add_effect.cmake cmake/plugin_exports.map cmake/postfx_warnings.cmake cmake/embed_glsl.cmake
        DESTINATION ${config_dir})
install(DIRECTORY framework/include/postfx DESTINATION include)

# The program finds its effects and data from its own place (catalog.hpp, host/run/resources.hpp).
get_property(effects DIRECTORY PROPERTY BUILDSYSTEM_TARGETS)
list(FILTER effects INCLUDE REGEX "^postfx_effect_")
# A module whose effect's folder is gone would still be found and used.
file(GLOB built ${PROJECT_BINARY_DIR}/postfx_plugins/postfx_*)
foreach(file ${built})
  string(REGEX REPLACE "^.*/postfx_([a-z0-9_]*)\\..*$" "postfx_effect_\\1" target ${file})
  if(NOT target IN_LIST effects)
    file(REMOVE ${file})
  elseif(file MATCHES "\\.study\\.yaml$")
    install(FILES ${file} DESTINATION lib/postfx/plugins-${abi_major})
  endif()
endforeach()
if(effects)
  install(TARGETS ${effects} LIBRARY DESTINATION lib/postfx/plugins-${abi_major})
endif()
install(TARGETS postfx_program RUNTIME DESTINATION bin)
install(DIRECTORY configs templates DESTINATION share/postfx)
