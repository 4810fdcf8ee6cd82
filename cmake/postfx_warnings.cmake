# Warnings are errors in our own code; third-party headers are SYSTEM.
function(postfx_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                                           -Wnon-virtual-dtor -Werror)
endfunction()
