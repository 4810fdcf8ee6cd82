// Text of OBJ and MTL files as assimp understands it, which does not know all that such files may hold.
#pragma once

#include <glm/glm.hpp>

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace postfx::host {

/// Where pictures lie that an MTL file scales (-s) or moves (-o): (u, v, 1) of the vertices to those of the picture, by
/// material and statement in small letters, as {"bark", "map_kd"}.
using MtlPlacements = std::map<std::pair<std::string, std::string>, glm::mat3x2>;

struct ObjText {
    std::string text;
    std::vector<std::string> libraries; ///< as mtllib names them
};

/// An OBJ with one blank between words, none before them, lines in one piece, a digit before every decimal point and a
/// line for each material library: names may have blanks in them, or several may share a line, which `is_file` tells.
ObjText plain_obj(std::string_view text, const std::function<bool(const std::string&)>& is_file);

/// An MTL likewise, names of pictures without quotes or blanks behind them; options that assimp does not know are left
/// out, and -s and -o are kept in `placements`. A picture of emission without Ke shines as it is.
std::string plain_mtl(std::string_view text, MtlPlacements& placements);

} // namespace postfx::host
