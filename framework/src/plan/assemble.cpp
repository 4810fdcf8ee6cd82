#include <plan/assemble.hpp>
#include <plan/taps.hpp>

#include <postfx_shader_library.h>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <functional>
#include <set>

namespace postfx {
namespace {

/// "glow_down" -> "GlowDown".
std::string pascal(std::string_view snake) {
    std::string name;
    bool start = true;
    for (char c : snake) {
        if (c == '_') {
            start = true;
        } else {
            name += start ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
            start = false;
        }
    }
    return name;
}

std::string struct_name(const Stage& stage) {
    return pascal(stage.function()) + "Params";
}

/// A GLSL literal that reads back as the same float.
std::string literal(double value, bool integer) {
    if (integer) return fmt::format("{}", static_cast<long long>(value));
    const float narrow = static_cast<float>(value);
    if (!std::isfinite(narrow)) {
        return fmt::format("uintBitsToFloat({:#x}u)", std::bit_cast<std::uint32_t>(narrow));
    }
    std::string text = fmt::format("{:.9g}", narrow);
    if (text.find_first_of(".en") == std::string::npos) text += ".0";
    return text;
}

const postfx_source* library_source(std::string_view name) {
    for (const postfx_source& source : postfx_embedded_sources) {
        if (name == source.name) return &source;
    }
    return nullptr;
}

std::string constant_line(const RecordedNumber& constant) {
    return fmt::format("const {} {} = {};\n", constant.integer ? "int" : "float", constant.name,
                       literal(constant.value[0], constant.integer));
}

bool is_integer(const BlockMember& member) {
    return member.type[0] == 'i' || member.type[0] == 'b';
}

/// "vec3(0.1, 0.2, 0.3)", "true", "7".
std::string constructor(const BlockMember& member) {
    if (member.type == "bool") return member.value[0] != 0 ? "true" : "false";
    std::string list;
    for (int i = 0; i < member.components; ++i) {
        list += (i ? ", " : "") + literal(member.value[i], is_integer(member));
    }
    return member.components == 1 ? list : fmt::format("{}({})", member.type, list);
}

std::string constructor(const Stage& stage) {
    std::string list;
    for (const BlockMember& member : stage.members)
        list += (list.empty() ? "" : ", ") + constructor(member);
    return fmt::format("{}({})", struct_name(stage), list.empty() ? "0.0" : list);
}

BlockMember target_size(const Numbers& numbers) {
    return {"target",
            "vec4",
            {double(numbers.width), double(numbers.height), 1.0 / numbers.width, 1.0 / numbers.height},
            4};
}

/// `u_frame`: the block at binding 0, or, folded, a variable of which only the changing part is read from it.
std::string frame_declaration(const Numbers& numbers) {
    constexpr std::string_view block = "layout(std140, binding = 0) uniform PostfxFrame {{ Frame {}; }};\n";
    if (!numbers.folded) return fmt::format(block, "u_frame");
    const FrameBlock& frame = numbers.frame;
    const auto pair = [](const float(&xy)[2]) {
        return fmt::format("vec2({}, {})", literal(xy[0], false), literal(xy[1], false));
    };
    return fmt::format(block, "u_live_frame")
           + fmt::format("Frame u_frame = Frame({}, {}, {}, {}, {}, {}, {}, u_live_frame.time, "
                         "u_live_frame.frame, u_live_frame.seed, {}, u_live_frame.view_to_world);\n",
                         pair(frame.size), pair(frame.inverse_size), pair(frame.depth_affine),
                         literal(frame.sky_depth, false), literal(frame.near_plane, false),
                         pair(frame.half_extent), frame.orthographic ? "true" : "false",
                         pair(frame.principal_point));
}

/// `target` (size and inverse size of what is drawn to) and a struct `stage_N` of each stage: members of the
/// block at binding 1, or constants.
std::string numbers_declaration(const std::vector<Stage>& stages, const Numbers& numbers) {
    std::string text;
    if (numbers.folded) {
        text = fmt::format("const vec4 target = {};\n", constructor(target_size(numbers)));
        for (std::size_t i = 0; i < stages.size(); ++i) {
            text +=
                fmt::format("const {} stage_{} = {};\n", struct_name(stages[i]), i, constructor(stages[i]));
        }
        return text;
    }
    text = "layout(std140, binding = 1) uniform PostfxStages {\n    vec4 target;\n";
    for (std::size_t i = 0; i < stages.size(); ++i) {
        text += fmt::format("    {} stage_{};\n", struct_name(stages[i]), i);
    }
    return text + "};\n";
}

std::string_view kind_name(ProgramKind kind) {
    switch (kind) {
    case ProgramKind::full_screen:
        return "full screen";
    case ProgramKind::tiles:
        return "tiles";
    case ProgramKind::compute:
        return "compute";
    }
    return "";
}

/// Collects a program: every file once, every constant and struct once.
class Assembly {
public:
    Assembly(ProgramKind kind, const Numbers& numbers) {
        program_.kind = kind;
        program_.counts_taps = numbers.count_taps;
        program_.text =
            fmt::format("#version 450 core // {}\n", kind_name(kind)); // in the text, so in its key
        if (program_.counts_taps) generated(tap_counter);
        library("prelude.glsl", Place{});
        generated(frame_declaration(numbers));
    }

    void library(std::string_view name, const Place& asked_from) {
        const postfx_source* source = library_source(name);
        if (!source) {
            throw Error(asked_from, fmt::format("no shader library file <postfx/{}>", name));
        }
        text(fmt::format("<postfx/{}>", name), source->text, nullptr);
    }

    void function(const Stage& stage) {
        if (!functions_.insert(stage.source).second) return;
        for (const RecordedNumber& constant : stage.constants) {
            if (constants_.insert(constant.name).second) program_.text += constant_line(constant);
        }
        program_.text += fmt::format("struct {} {{\n", struct_name(stage));
        for (const BlockMember& member : stage.members) {
            program_.text += fmt::format("    {} {};\n", member.type, member.name);
        }
        // GLSL has no empty structs.
        if (stage.members.empty()) program_.text += "    float postfx_no_parameters;\n";
        program_.text += "};\n";
        text(stage.source->name, stage.source->text, stage.effect.get());
    }

    void generated(std::string_view lines) {
        if (program_.files.empty() || program_.files.back() != "generated") begin_file("generated");
        program_.text += lines;
    }

    ProgramSource finish() {
        if (program_.counts_taps) generated(tap_counting_main);
        program_.key = std::hash<std::string>{}(program_.text);
        return std::move(program_);
    }

private:
    std::size_t begin_file(std::string name) {
        program_.files.push_back(std::move(name));
        program_.text += fmt::format("#line 1 {}\n", program_.files.size() - 1);
        return program_.files.size() - 1;
    }

    void text(const std::string& name, std::string_view glsl, const EffectInfo* effect) {
        if (!included_.insert({effect ? effect->module_path.string() : "", name}).second) return;
        const std::size_t file = begin_file(name);
        std::string counted;
        if (program_.counts_taps) {
            counted = with_taps_counted(name, glsl, effect);
            glsl = counted;
        }
        int line = 1;
        for (std::size_t at = 0; at < glsl.size(); ++line) {
            const std::size_t end = std::min(glsl.find('\n', at), glsl.size());
            const std::string_view row = glsl.substr(at, end - at);
            at = end + 1;
            if (row.find("#include") == row.find_first_not_of(" \t")
                && row.find("#include") != std::string::npos) {
                include(row, Place{.file = name, .line = line, .effect = effect ? effect->id : ""}, effect);
                program_.text += fmt::format("#line {} {}\n", line + 1, file);
            } else {
                program_.text.append(row).push_back('\n');
            }
        }
    }

    static std::string with_taps_counted(const std::string& name, std::string_view glsl,
                                         const EffectInfo* effect) {
        CountedText counted = count_taps(glsl);
        if (!counted.why_not.empty()) {
            throw Error(Place{.file = name, .effect = effect ? effect->id : ""},
                        fmt::format("its texture reads can't be counted: {}", counted.why_not));
        }
        return std::move(counted.glsl);
    }

    void include(std::string_view row, const Place& place, const EffectInfo* effect) {
        const std::size_t open = row.find_first_of("<\"");
        const std::size_t close = row.find_last_of(">\"");
        if (open == std::string::npos || close <= open) {
            throw Error(place, "#include expects <postfx/name.glsl> or \"name.glsl\"");
        }
        const std::string name(row.substr(open + 1, close - open - 1));
        constexpr std::string_view prefix = "postfx/";
        if (row[open] == '<' && name.starts_with(prefix)) return library(name.substr(prefix.size()), place);
        const SourceInfo* source = effect ? effect->find_source(name) : nullptr;
        if (!source)
            throw Error(place, fmt::format("#include of \"{}\", which the plugin does not have", name));
        if (!source->not_pointwise.empty()) {
            throw Error(Place{.file = name, .effect = effect->id},
                        fmt::format("can't be included: {}", source->not_pointwise));
        }
        text(source->name, source->text, effect);
    }

    ProgramSource program_;
    std::set<const SourceInfo*> functions_;
    std::set<std::pair<std::string, std::string>> included_;
    std::set<std::string> constants_;
};

std::string sampler_name(std::size_t stage, const std::string& sampler) {
    return fmt::format("u_stage_{}_{}", stage, sampler);
}

std::string sampler_declarations(const std::vector<Stage>& stages, int first_unit) {
    std::string text;
    int unit = first_unit;
    for (std::size_t i = 0; i < stages.size(); ++i) {
        for (const std::string& sampler : stages[i].samplers) {
            text +=
                fmt::format("layout(binding = {}) uniform sampler2D {};\n", unit++, sampler_name(i, sampler));
        }
    }
    return text;
}

std::string arguments(const std::vector<Stage>& stages, std::size_t i) {
    std::string text = fmt::format("pixel, stage_{}", i);
    for (const std::string& sampler : stages[i].samplers)
        text += ", " + sampler_name(i, sampler);
    return text;
}

constexpr std::string_view main_start =
    "void main() {\n"
    "    const Pixel pixel = Pixel(ivec2(gl_FragCoord.xy), gl_FragCoord.xy, gl_FragCoord.xy * target.zw,\n"
    "                              ivec2(target.xy));\n";

/// Writes numbers where std140 wants them.
class Std140 {
public:
    void align(std::size_t alignment) {
        bytes_.resize((bytes_.size() + alignment - 1) / alignment * alignment);
    }

    void member(const BlockMember& member) {
        constexpr std::size_t alignments[] = {0, 4, 8, 16, 16};
        align(alignments[member.components]);
        for (int i = 0; i < member.components; ++i) {
            if (is_integer(member)) {
                append(static_cast<std::int32_t>(member.value[i]));
            } else {
                append(static_cast<float>(member.value[i]));
            }
        }
    }

    void structure(const Stage& stage) {
        align(16);
        for (const BlockMember& value : stage.members)
            member(value);
        if (stage.members.empty()) member({"postfx_no_parameters", "float", {}, 1});
    }

    std::vector<std::byte> finish() {
        align(16);
        return std::move(bytes_);
    }

private:
    template<class Number>
    void append(Number number) {
        bytes_.resize(bytes_.size() + sizeof(number));
        std::memcpy(bytes_.data() + bytes_.size() - sizeof(number), &number, sizeof(number));
    }

    std::vector<std::byte> bytes_;
};

std::string_view parameter_type(const ParameterInfo& parameter) {
    switch (parameter.kind) {
    case ParameterKind::number:
        return "float";
    case ParameterKind::color:
        return "vec3";
    case ParameterKind::toggle:
        return "bool";
    case ParameterKind::integer:
    case ParameterKind::choice:
        return "int";
    }
    return "";
}

} // namespace

std::string Stage::function() const {
    return source->name.substr(0, source->name.rfind('.'));
}

Stage make_stage(const ChainEntry& entry, const RecordedPass& pass) {
    Stage stage;
    stage.entry = entry.name;
    stage.effect = entry.effect;
    stage.source = pass.source;
    for (std::size_t i = 0; i < entry.effect->parameters.size(); ++i) {
        const ParameterInfo& parameter = entry.effect->parameters[i];
        if (!pass.source->names[i]) continue;
        if (parameter.constant) {
            stage.constants.push_back(
                {parameter.glsl_name, parameter.kind != ParameterKind::number, 1, entry.values[i]});
        } else {
            stage.members.push_back({parameter.glsl_name, std::string(parameter_type(parameter)),
                                     entry.values[i], parameter.components()});
        }
    }
    for (const RecordedNumber& value : pass.values) {
        const std::string scalar = value.integer ? "int" : "float";
        const std::string vector = fmt::format("{}vec{}", value.integer ? "i" : "", value.components);
        stage.members.push_back(
            {value.name, value.components == 1 ? scalar : vector, value.value, value.components});
    }
    stage.constants.insert(stage.constants.end(), pass.constants.begin(), pass.constants.end());
    for (const RecordedInput& input : pass.inputs)
        stage.samplers.push_back(input.name);
    return stage;
}

std::string why_not_together(const Stage& a, const Stage& b) {
    if (a.source != b.source && a.function() == b.function()) {
        return fmt::format("{} and {} both define the function {}", a.entry, b.entry, a.function());
    }
    if (a.source == b.source && a.members != b.members) {
        return fmt::format("{} and {} use one function with different values", a.entry, b.entry);
    }
    for (const RecordedNumber& constant : a.constants) {
        const auto same =
            std::find_if(b.constants.begin(), b.constants.end(),
                         [&](const RecordedNumber& other) { return other.name == constant.name; });
        if (same != b.constants.end()
            && (same->value != constant.value || same->integer != constant.integer)) {
            return fmt::format("{} and {} are compiled with different {}", a.entry, b.entry, constant.name);
        }
    }
    return "";
}

ProgramSource assemble_compose(const std::vector<Stage>& stages, Finish finish, const Numbers& numbers) {
    Assembly assembly(ProgramKind::full_screen, numbers);
    for (const Stage& stage : stages)
        assembly.function(stage);
    if (finish.encoding != Encoding::none) assembly.library("output.glsl", Place{});
    // Declared only now, so that no effect's function can name the chain's stored colour.
    assembly.generated(numbers_declaration(stages, numbers));
    assembly.generated("layout(binding = 0) uniform sampler2D u_color;\n");
    assembly.generated(sampler_declarations(stages, 1));
    assembly.generated("layout(location = 0) out vec4 o_color;\n");
    assembly.generated(main_start);
    assembly.generated(
        "    vec4 stored = postfx_stored(u_color, pixel.index);\n    vec3 color = stored.rgb;\n");
    for (std::size_t i = 0; i < stages.size(); ++i) {
        assembly.generated(
            fmt::format("    color = {}(color, {});\n", stages[i].function(), arguments(stages, i)));
    }
    if (finish.divide_by_alpha) assembly.generated("    color = postfx_divided_by_alpha(color, stored.a);\n");
    if (finish.encoding == Encoding::srgb) assembly.generated("    color = postfx_encode(color);\n");
    if (finish.encoding == Encoding::srgb_dithered)
        assembly.generated("    color = postfx_encode_dithered(color, pixel);\n");
    assembly.generated("    o_color = vec4(color, stored.a);\n}\n");
    return assembly.finish();
}

ProgramSource assemble_fragment(const Stage& stage, int outputs, bool tiled, const Numbers& numbers) {
    Assembly assembly(tiled ? ProgramKind::tiles : ProgramKind::full_screen, numbers);
    assembly.function(stage);
    assembly.generated(numbers_declaration({stage}, numbers));
    assembly.generated(sampler_declarations({stage}, 0));
    for (int i = 0; i < outputs; ++i) {
        assembly.generated(fmt::format("layout(location = {}) out vec4 o_{};\n", i, i));
    }
    assembly.generated(main_start);
    if (outputs == 1) {
        assembly.generated(fmt::format("    o_0 = {}({});\n}}\n", stage.function(), arguments({stage}, 0)));
    } else {
        std::string results;
        for (int i = 0; i < outputs; ++i)
            results += fmt::format(", o_{}", i);
        assembly.generated(
            fmt::format("    {}({}{});\n}}\n", stage.function(), arguments({stage}, 0), results));
    }
    return assembly.finish();
}

ProgramSource assemble_decision(const Stage& stage, int decision, const std::vector<CensusInput>& censuses,
                                const Numbers& numbers) {
    Assembly assembly(ProgramKind::compute, numbers);
    assembly.library("decide.glsl", Place{});
    assembly.function(stage);
    assembly.generated(numbers_declaration({stage}, numbers));
    std::string list;
    for (const CensusInput& input : censuses)
        list += fmt::format("{}({}u), ", input.depth ? "postfx_depth_census" : "postfx_census", input.slot);
    assembly.generated(fmt::format("void main() {{\n    postfx_decide({}u, {}({}stage_0));\n}}\n", decision,
                                   stage.function(), list));
    return assembly.finish();
}

ProgramSource assemble_census(bool depth, const Numbers& numbers) {
    Assembly assembly(ProgramKind::compute, numbers);
    assembly.library(depth ? "census_depth.glsl" : "census_color.glsl", Place{});
    return assembly.finish();
}

std::string program_key(const std::vector<Stage>& stages, std::string_view form, const Numbers& numbers) {
    std::string key(numbers.count_taps ? "taps " : "");
    key += form;
    for (const Stage& stage : stages) {
        key += fmt::format("|{}:{}", static_cast<const void*>(stage.source), stage.samplers.size());
        for (const BlockMember& member : stage.members)
            key += fmt::format(",{} {}", member.type, member.name);
        for (const RecordedNumber& constant : stage.constants) {
            key += fmt::format(",{}={}", constant.name, literal(constant.value[0], constant.integer));
        }
        if (numbers.folded) key += "=" + constructor(stage);
    }
    return numbers.folded ? key + numbers_declaration({}, numbers) + frame_declaration(numbers) : key;
}

std::vector<std::byte> uniform_block(const std::vector<Stage>& stages, const Numbers& numbers) {
    if (numbers.folded) return {};
    Std140 block;
    block.member(target_size(numbers));
    for (const Stage& stage : stages)
        block.structure(stage);
    return block.finish();
}

std::size_t struct_bytes(const Stage& stage) {
    Std140 block;
    block.structure(stage);
    return block.finish().size();
}

} // namespace postfx
