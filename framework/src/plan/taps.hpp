// Programs that count their texture reads while they run: loops end early, so reading the text does not tell.
#pragma once

#include <string>
#include <string_view>

namespace postfx {

/// Stands before everything else in a program that counts: an invocation's counter, and the pass's sum (storage
/// buffer 0: two words, the low one first), to which every invocation adds when it ends.
extern const std::string_view tap_counter;
/// Stands at the program's end; its main() before this is another function from then on.
extern const std::string_view tap_counting_main;

struct CountedText {
    std::string glsl;    ///< line by line the same, without comments
    std::string why_not; ///< as "line 3: names texelFetch without calling it"; empty if every read is counted
};

/// Make every call that reads a texture or an image add 1 to the counter; textureGather() is one call. What could
/// read without being seen here is refused. A function that is declared with the name of a built-in one does not
/// compile.
CountedText count_taps(std::string_view glsl);

} // namespace postfx
