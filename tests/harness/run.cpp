// Running effects for tests: one context, one catalog per process.
#include <testing.hpp>

#include <gl/context.hpp>
#include <gl/objects.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace postfx::testing {
namespace {

/// The process's context, or why there is none.
struct Context {
    std::unique_ptr<gl::HeadlessContext> context;
    std::string problem;

    static const Context& get() {
        static const Context made = [] {
            Context result;
            try {
                result.context = std::make_unique<gl::HeadlessContext>(true);
            } catch (const Error& error) {
                result.problem = error.what();
            }
            return result;
        }();
        return made;
    }
};

void require_gl() {
    std::string why;
    if (!has_gl(&why)) throw Error(why);
}

/// `id` is a parameter, or a channel of a color: "tint.2".
void set_number(ChainEntry& entry, const std::string& id, double value) {
    const std::size_t dot = id.find('.');
    if (dot == std::string::npos) {
        if (entry.set(id, value)) return;
        throw Error(fmt::format("{}.{} = {} is out of range", entry.effect->id, id, value));
    }
    const std::string parameter = id.substr(0, dot);
    const auto index = entry.effect->find_parameter(parameter);
    if (!index) throw Error(fmt::format("{} has no parameter {}", entry.effect->id, parameter));
    entry.values[*index][static_cast<std::size_t>(id[dot + 1] - '0')] = value;
}

Chain single(const std::string& effect, const Values& values) {
    Chain chain;
    ChainEntry& entry = chain.add(catalog(), effect);
    for (const auto& [id, value] : values) {
        if (id == "quality") {
            set_level(entry, value.word);
        } else if (id == "skip") {
            const auto skip = skip_by_word(value.word);
            if (!skip) throw Error(fmt::format("skip: expected a word of Skip, found \"{}\"", value.word));
            chain.skip = *skip;
        } else if (!value.word.empty()) {
            throw Error(fmt::format("{}.{} is a number here, found \"{}\"", effect, id, value.word));
        } else {
            set_number(entry, id, value.number);
        }
    }
    return chain;
}

/// Four channels, alpha 1 where there was none.
Image with_alpha(const Image& image) {
    if (image.channels == 4) return image;
    Image result(image.width, image.height, 4, 1.0f);
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        for (int c = 0; c < std::min(image.channels, 3); ++c) {
            result.values[4 * i + c] = image.values[image.channels * i + c];
        }
    }
    return result;
}

Image run(const Chain& chain, const Input& input, const PlanOptions& options) {
    require_gl();
    static Planner planner;
    Runner runner;
    runner.prepare(planner.plan(chain, facts_of(input), options));
    return runner.draw(input);
}

} // namespace

const Catalog& catalog() {
    static const Catalog found = Catalog::discover();
    return found;
}

std::vector<std::string> names_of_levels(const EffectInfo& effect) {
    std::vector<std::string> names;
    for (const LevelInfo& level : effect.levels)
        names.push_back(level.id);
    return names.empty() ? std::vector<std::string>{""} : names;
}

void set_level(ChainEntry& entry, std::string_view level) {
    const std::vector<std::string> names = names_of_levels(*entry.effect);
    const auto found = std::find(names.begin(), names.end(), level);
    if (found == names.end()) {
        throw Error(Place{.effect = entry.name},
                    fmt::format("has no level \"{}\"; expected one of {}", level, fmt::join(names, ", ")));
    }
    entry.level = static_cast<int>(found - names.begin());
}

SceneFacts facts_of(const Input& input) {
    SceneFacts facts;
    facts.width = input.color.width;
    facts.height = input.color.height;
    facts.camera = input.camera;
    for (const auto& [name, image] : input.attachments)
        facts.attachments.push_back(name);
    return facts;
}

PlanOptions linear_output(Format working_format) {
    return {.output = Output::linear, .working_format = working_format};
}

void Runner::prepare(Plan plan) {
    executor_.prepare(plan);
    plan_ = std::move(plan);
}

Image Runner::draw(const Input& input) {
    std::vector<gl::Texture> textures;
    FrameInputs frame;
    for (const std::string& name : plan_.attachments) {
        const Image& image = name == "color" ? input.color : input.attachments.at(name);
        const bool data = name == "depth";
        textures.emplace_back(image.width, image.height, data ? Format::r32f : Format::rgba32f);
        textures.back().upload(data ? image : with_alpha(image));
        frame.textures.push_back(textures.back().name());
    }
    frame.camera = input.camera;
    frame.time = input.time;
    frame.frame = input.frame;
    frame.seed = input.seed;
    executor_.run(frame);
    Image picture = executor_.read_picture();
    const std::vector<std::string> messages = gl::take_debug_messages();
    if (!messages.empty()) throw Error("OpenGL says: " + messages.front());
    return picture;
}

bool has_gl(std::string* why) {
    const Context& context = Context::get();
    if (why) *why = context.problem;
    return context.context != nullptr;
}

Image run_effect(const std::string& effect, const Input& input, const Values& values, Format working_format) {
    return run(single(effect, values), input, linear_output(working_format));
}

Image run_chain(const std::string& yaml, const Input& input, Format working_format, bool fuse) {
    PlanOptions options = linear_output(working_format);
    options.fuse = fuse;
    return run(parse_chain(yaml, "test.yaml", catalog()), input, options);
}

Plan plan_effect(const std::string& effect, const Input& input, const Values& values) {
    return Planner().plan(single(effect, values), facts_of(input), linear_output());
}

double ReferenceInput::value(const std::string& id) const {
    const auto found = values.find(id);
    if (found == values.end()) throw Error("the reference asks for an undeclared parameter: " + id);
    return found->second;
}

int ReferenceInput::level_among(std::initializer_list<std::string_view> names) const {
    const auto found = std::find(names.begin(), names.end(), level);
    if (found == names.end()) throw Error(fmt::format("the reference has no level \"{}\"", level));
    return static_cast<int>(found - names.begin());
}

ReferenceInput reference_input(const std::string& effect, const Input& input, const Values& values) {
    ReferenceInput result;
    result.color = convert<double>(input.color);
    for (const auto& [name, image] : input.attachments)
        result.attachments[name] = convert<double>(image);
    result.camera = input.camera;
    result.time = input.time;
    result.frame = input.frame;
    result.seed = input.seed;
    const Chain chain = single(effect, values);
    const ChainEntry& entry = chain.entries.front();
    for (std::size_t i = 0; i < entry.values.size(); ++i) {
        const ParameterInfo& parameter = entry.effect->parameters[i];
        if (parameter.components() == 1) {
            result.values[parameter.id] = entry.values[i][0];
        } else {
            for (int c = 0; c < parameter.components(); ++c) {
                result.values[fmt::format("{}.{}", parameter.id, c)] = entry.values[i][c];
            }
        }
    }
    result.level = names_of_levels(*entry.effect)[static_cast<std::size_t>(entry.level)];
    return result;
}

} // namespace postfx::testing
