# postfx_add_effect(<name> [DIRECTORY <dir>] [OUTPUT_DIRECTORY <dir>])
#
# Builds one effect from its folder: <name>.cpp (and other *.cpp but reference.cpp, test.cpp, test_*.cpp) with every *.glsl
# embedded, as the plugin postfx_<name>.so in OUTPUT_DIRECTORY (<build>/postfx_plugins). With test.cpp and reference.cpp there, also the test
# <name>_gl_test. With study.yaml there, how `postfx study` looks at it; with truth/ there, in the postfx tree, what it ought to give
# (postfx_add_truth.cmake). In the postfx tree it is called for every folder of plugins/; an out-of-tree effect calls it after
# find_package(postfx).

set(POSTFX_CMAKE_DIR ${CMAKE_CURRENT_LIST_DIR})

# Make <header> with the *.glsl of <directory> as a constexpr array `postfx_embedded_sources`, for <target> to include.
function(postfx_embed_glsl target directory header)
  file(GLOB sources CONFIGURE_DEPENDS ${directory}/*.glsl)
  set(out_dir ${CMAKE_CURRENT_BINARY_DIR}/${target}_glsl)
  set(out ${out_dir}/${header})
  add_custom_command(
    OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -D OUT=${out} -D "SOURCES=${sources}" -P ${POSTFX_CMAKE_DIR}/embed_glsl.cmake
    DEPENDS ${sources} ${POSTFX_CMAKE_DIR}/embed_glsl.cmake
    COMMENT "Embedding GLSL of ${target}"
    VERBATIM)
  target_sources(${target} PRIVATE ${out})
  target_include_directories(${target} PRIVATE ${out_dir})
endfunction()

function(postfx_add_effect name)
  cmake_parse_arguments(effect "" "DIRECTORY;OUTPUT_DIRECTORY" "" ${ARGN})
  if(NOT effect_DIRECTORY)
    set(effect_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
  endif()
  if(NOT effect_OUTPUT_DIRECTORY)
    set(effect_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/postfx_plugins)
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${effect_DIRECTORY}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/(reference|test|test_[a-z_]+)\\.cpp$")
  set(target postfx_effect_${name})
  add_library(${target} MODULE ${sources})
  set_target_properties(${target} PROPERTIES
    PREFIX "" OUTPUT_NAME postfx_${name}
    LIBRARY_OUTPUT_DIRECTORY ${effect_OUTPUT_DIRECTORY}
    CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_link_libraries(${target} PRIVATE postfx::plugin_headers)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -fno-gnu-unique)
  endif()
  target_link_options(${target} PRIVATE -Wl,--version-script=${POSTFX_CMAKE_DIR}/plugin_exports.map)
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${POSTFX_CMAKE_DIR}/plugin_exports.map)
  if(NOT POSTFX_SANITIZE)
    target_link_options(${target} PRIVATE -Wl,-z,defs)
  endif()
  postfx_warnings(${target})
  postfx_embed_glsl(${target} ${effect_DIRECTORY} postfx_embedded_sources.h)

  if(TARGET postfx::gl_test_main AND EXISTS ${effect_DIRECTORY}/test.cpp)
    file(GLOB more_tests CONFIGURE_DEPENDS ${effect_DIRECTORY}/test_*.cpp)
    add_executable(${name}_gl_test ${effect_DIRECTORY}/test.cpp ${effect_DIRECTORY}/reference.cpp ${more_tests})
    target_link_libraries(${name}_gl_test PRIVATE postfx::gl_test_main)
    target_compile_definitions(${name}_gl_test PRIVATE POSTFX_EFFECT_DIRECTORY="${effect_DIRECTORY}")
    set_target_properties(${name}_gl_test PROPERTIES CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF)
    postfx_warnings(${name}_gl_test)
    add_dependencies(${name}_gl_test ${target})
    add_test(NAME ${name}_gl_test COMMAND ${name}_gl_test)
    set_tests_properties(${name}_gl_test PROPERTIES
      ENVIRONMENT "POSTFX_PLUGIN_PATH=${CMAKE_BINARY_DIR}/postfx_plugins" SKIP_RETURN_CODE 77)
  endif()

  # How the program studies it lies beside its module.
  set(studied ${effect_OUTPUT_DIRECTORY}/postfx_${name}.study.yaml)
  file(GLOB study CONFIGURE_DEPENDS ${effect_DIRECTORY}/study.yaml)
  if(study)
    configure_file(${study} ${studied} COPYONLY)
  else()
    file(REMOVE ${studied})
  endif()

  file(GLOB truth CONFIGURE_DEPENDS ${effect_DIRECTORY}/truth/*.cpp)
  if(truth)
    if(COMMAND postfx_add_truth)
      postfx_add_truth(${name} ${effect_DIRECTORY}/truth)
    else()
      message(STATUS "${name}: truth/ is left out: truths are part of the program, which is built in postfx's own tree")
    endif()
  endif()
endfunction()

# Every folder of <directory> is an effect of the folder's name. The target postfx_effects is all of them.
function(postfx_add_effects_in directory)
  add_custom_target(postfx_effects)
  file(GLOB folders CONFIGURE_DEPENDS ${directory}/*)
  foreach(folder ${folders})
    get_filename_component(name ${folder} NAME)
    if(EXISTS ${folder}/${name}.cpp)
      postfx_add_effect(${name} DIRECTORY ${folder})
      add_dependencies(postfx_effects postfx_effect_${name})
    elseif(IS_DIRECTORY ${folder})
      message(WARNING "${folder} is no effect: it has no ${name}.cpp")
    endif()
  endforeach()
endfunction()
