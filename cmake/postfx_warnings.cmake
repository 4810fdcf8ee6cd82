# Warnings are errors in our own code; third-party headers are SYSTEM.
function(postfx_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion
                                           -Wnon-virtual-dtor -Werror
                                           $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local>)
endfunction()
