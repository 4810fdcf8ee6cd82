# What an effect ought to give, from its folder's truth/: truths and metrics, which register themselves with the study, and
# their tests. They link the truths' machinery and nothing of the effect. Part of the program, so for effects of the tree only.

# All of them, with the machinery: what the program links, and what tests that go through all truths do.
add_library(postfx_truths_of_effects INTERFACE)
target_link_libraries(postfx_truths_of_effects INTERFACE postfx_truths)

# postfx_add_truth(<effect> <directory>): the *.cpp of <directory> but test*.cpp as objects, none of which a linker drops. With
# POSTFX_TESTS also the tests <effect>_truth_test of its test*.cpp, and <effect>_truth_gl_test of those that end in _gl.cpp.
function(postfx_add_truth effect directory)
  file(GLOB sources CONFIGURE_DEPENDS ${directory}/*.cpp)
  set(tests ${sources})
  list(FILTER sources EXCLUDE REGEX "/test[a-z_]*\\.cpp$")
  list(FILTER tests INCLUDE REGEX "/test[a-z_]*\\.cpp$")
  set(target postfx_truth_${effect})
  add_library(${target} OBJECT ${sources})
  target_link_libraries(${target} PRIVATE postfx_truths fmt::fmt)
  postfx_warnings(${target})
  target_link_libraries(postfx_truths_of_effects INTERFACE $<TARGET_OBJECTS:${target}>)
  if(POSTFX_TESTS)
    set(gl_tests ${tests})
    list(FILTER gl_tests INCLUDE REGEX "_gl\\.cpp$")
    list(FILTER tests EXCLUDE REGEX "_gl\\.cpp$")
    postfx_add_truth_test(${effect} ${effect}_truth_test postfx_test_main "${tests}")
    postfx_add_truth_test(${effect} ${effect}_truth_gl_test postfx_gl_test_main "${gl_tests}")
  endif()
endfunction()

function(postfx_add_truth_test effect name main sources)
  if(NOT sources)
    return()
  endif()
  add_executable(${name} ${sources})
  target_link_libraries(${name} PRIVATE ${main} postfx_truth_${effect} postfx_truths_testing)
  postfx_warnings(${name})
  add_dependencies(${name} postfx_effect_${effect})
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES
    ENVIRONMENT "POSTFX_PLUGIN_PATH=${PROJECT_BINARY_DIR}/postfx_plugins" SKIP_RETURN_CODE 77)
endfunction()
