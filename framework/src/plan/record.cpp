#include <plan/record.hpp>

#include <plugin/declarations.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace postfx {
namespace {

constexpr int largest_side = 32768; // no device has more; what the one at hand has, the executor asks

/// A word that a plugin may have left out.
std::string_view word_of(const char* text) {
    return text ? text : "";
}

/// What keeps an effect from being planned. Thrown between record()'s own functions only; never crosses the plugin.
struct Wrong {
    std::string message;
    bool by_refusal = false; ///< of its values, by the effect; otherwise a mistake in what it declares
};

/// Receives the calls of one plan(). No exception may leave a callback: the plugin is not ours, so the first
/// problem is kept and everything after it ignored.
class Recorder {
public:
    Recorder(const ChainEntry& entry, const SceneFacts& facts, Format working_format, Skip skip)
        : entry_(entry), facts_(facts), working_format_(working_format), skip_(skip) {
        abi_.struct_size = sizeof(postfx_builder);
        abi_.context = this;
        abi_.identity = on_identity;
        abi_.lacks = on_lacks;
        abi_.refuse = on_refuse;
        abi_.color = on_color;
        abi_.attachment = on_attachment;
        abi_.pass = on_pass;
        abi_.decide = on_decide;
        abi_.size = on_size;
        abi_.fail = on_fail;
    }

    const postfx_builder& abi() const { return abi_; }

    Recording finish() {
        guarded([&] { check_complete(); });
        if (!problem_) return std::move(recording_);
        const Place place{.effect = entry_.name};
        if (problem_->by_refusal) throw Refusal(place, problem_->message);
        throw Error(place, problem_->message);
    }

private:
    static Recorder& self(void* context) { return *static_cast<Recorder*>(context); }

    void guarded(const std::function<void()>& body) {
        if (problem_) return;
        try {
            body();
        } catch (const Wrong& wrong) {
            problem_ = wrong;
        } catch (const std::exception& error) {
            problem_ = Wrong{error.what()};
        }
    }

    void check_complete() const {
        const bool composed = !recording_.passes.empty() && recording_.passes.back().compose;
        if (recording_.identity && !recording_.passes.empty()) {
            throw Wrong{"says that it is the identity, and declares passes"};
        }
        if (!recording_.identity && !composed) throw Wrong{"says neither identity() nor ends with compose()"};
    }

    static std::int32_t on_identity(void* context, const char* moment, const char* kind, const char* reason) {
        std::int32_t accepted = 1; // whatever is wrong: nothing more need be declared
        self(context).guarded(
            [&] { accepted = self(context).identity(word_of(moment), word_of(kind), word_of(reason)); });
        return accepted;
    }
    static void on_lacks(void* context, const char* reason) {
        self(context).guarded([&] {
            self(context).recording_.identity =
                Identity{Moment::scene, SkipKind::lacks, std::string(word_of(reason))};
        });
    }
    static void on_decide(void* context, const postfx_decision* decision) {
        self(context).guarded([&] { self(context).decide(copy_abi<postfx_decision>(decision)); });
    }
    static void on_refuse(void* context, const char* message) {
        self(context).guarded(
            [&] { throw Wrong{.message = std::string(word_of(message)), .by_refusal = true}; });
    }
    static void on_fail(void* context, const char* message) {
        self(context).guarded([&] { throw Wrong{std::string(word_of(message))}; });
    }
    static postfx_image on_color(void* context) {
        postfx_image handle = 0;
        self(context).guarded([&] { handle = self(context).color(); });
        return handle;
    }
    static postfx_image on_attachment(void* context, const char* name) {
        postfx_image handle = 0;
        self(context).guarded([&] { handle = self(context).attachment(std::string(word_of(name))); });
        return handle;
    }
    static postfx_image on_pass(void* context, const postfx_pass* pass) {
        postfx_image handle = 0;
        self(context).guarded([&] { handle = self(context).pass(copy_abi<postfx_pass>(pass)); });
        return handle;
    }
    static void on_size(void* context, postfx_image image, std::uint32_t* width, std::uint32_t* height) {
        self(context).guarded([&] {
            const RecordedImage& found =
                self(context).recording_.images[self(context).index(image, "size()")];
            *width = static_cast<std::uint32_t>(found.width);
            *height = static_cast<std::uint32_t>(found.height);
        });
    }

    /// Throws Wrong when an effect can't say that.
    static SkipKind skip_kind(std::string_view word) {
        const std::optional<SkipKind> kind = skip_kind_by_word(word);
        if (!kind || kind == SkipKind::lacks)
            throw Wrong{fmt::format("would be skipped for the unknown kind \"{}\"", word)};
        return *kind;
    }

    /// May the chain leave out what changes so much?
    bool is_allowed(SkipKind kind) const {
        switch (kind) {
        case SkipKind::exact:
            return skip_ >= Skip::exact;
        case SkipKind::code:
            return skip_ >= Skip::code;
        case SkipKind::visible:
            return skip_ >= Skip::visible;
        case SkipKind::lacks:
            return true;
        }
        return false;
    }

    bool identity(std::string_view when, std::string_view what, std::string_view reason) {
        const std::optional<Moment> moment = moment_by_word(when);
        if (!moment || moment == Moment::frame)
            throw Wrong{fmt::format("is the identity at the unknown moment \"{}\"", when)};
        const SkipKind kind = skip_kind(what);
        if (!is_allowed(kind)) return false;
        recording_.identity = Identity{*moment, kind, std::string(reason)};
        return true;
    }

    void decide(const postfx_decision& declared) {
        const std::string_view source = word_of(declared.source);
        if (recording_.decision) throw Wrong{"asks the frame twice"};
        if (!recording_.passes.empty()) throw Wrong{"asks the frame after it declared passes"};
        const SkipKind kind = skip_kind(word_of(declared.kind));
        if (!is_allowed(kind)) return;
        RecordedDecision made;
        made.pass.name = "decision";
        made.pass.source = entry_.effect->find_source(source);
        if (!made.pass.source) throw Wrong{fmt::format("has no source \"{}\" (decision)", source)};
        if (declared.input_count < 1 || declared.input_count > most_pass_inputs) {
            throw Wrong{fmt::format("decides by {} images", declared.input_count)};
        }
        read_inputs_and_numbers(declared, made.pass);
        made.decision = {kind, std::string(word_of(declared.compared)), std::string(word_of(declared.limit))};
        recording_.decision = std::move(made);
    }

    /// Of a postfx_pass or postfx_decision.
    template<class Abi>
    void read_inputs_and_numbers(const Abi& declared, RecordedPass& pass) const {
        for (std::uint32_t i = 0; i < declared.input_count; ++i) {
            pass.inputs.push_back(input(abi_element(declared.inputs, declared.input_stride, i), pass.name));
        }
        for (std::uint32_t i = 0; i < declared.value_count; ++i) {
            pass.values.push_back(number(abi_element(declared.values, declared.value_stride, i), pass.name));
        }
        for (std::uint32_t i = 0; i < declared.constant_count; ++i) {
            pass.constants.push_back(
                number(abi_element(declared.constants, declared.constant_stride, i), pass.name));
            const RecordedNumber& constant = pass.constants.back();
            if (!std::isfinite(constant.value[0])) {
                throw Wrong{fmt::format("pass {}: the constant {} is {}", pass.name, constant.name,
                                        constant.value[0])};
            }
        }
    }

    postfx_image add_image(RecordedImage image) {
        recording_.images.push_back(std::move(image));
        return static_cast<postfx_image>(recording_.images.size());
    }

    int index(postfx_image handle, std::string_view user) const {
        if (handle == 0 || handle > recording_.images.size()) {
            throw Wrong{
                fmt::format("{} gets an image that does not exist (is an attachment missing?)", user)};
        }
        return static_cast<int>(handle) - 1;
    }

    postfx_image color() {
        for (std::size_t i = 0; i < recording_.images.size(); ++i) {
            if (recording_.images[i].kind == RecordedImage::Kind::color)
                return static_cast<postfx_image>(i + 1);
        }
        return add_image({RecordedImage::Kind::color, "", -1, 0, facts_.width, facts_.height});
    }

    postfx_image attachment(const std::string& name) {
        const auto& declared = entry_.effect->reads;
        if (std::find(declared.begin(), declared.end(), name) == declared.end()) {
            throw Wrong{fmt::format("asks for the attachment \"{}\", which it does not declare", name)};
        }
        if (std::find(facts_.attachments.begin(), facts_.attachments.end(), name)
            == facts_.attachments.end()) {
            return 0;
        }
        return add_image({RecordedImage::Kind::attachment, name, -1, 0, facts_.width, facts_.height});
    }

    postfx_image pass(const postfx_pass& declared) {
        RecordedPass pass;
        pass.name = word_of(declared.name);
        const std::string_view kind = word_of(declared.kind), source = word_of(declared.source);
        pass.compose = kind == "compose";
        if (!pass.compose && kind != "fragment") {
            throw Wrong{fmt::format("pass {} has the unknown kind \"{}\"", pass.name, kind)};
        }
        if (!recording_.passes.empty() && recording_.passes.back().compose) {
            throw Wrong{fmt::format("declares pass {} after compose()", pass.name)};
        }
        pass.source = entry_.effect->find_source(source);
        if (!pass.source) throw Wrong{fmt::format("has no source \"{}\" (pass {})", source, pass.name)};
        if (pass.compose && !pass.source->not_pointwise.empty()) {
            throw Wrong{fmt::format("{} can't be composed: {}", source, pass.source->not_pointwise)};
        }
        pass.width = static_cast<int>(declared.width);
        pass.height = static_cast<int>(declared.height);
        if (declared.width < 1 || declared.height < 1 || declared.width > largest_side
            || declared.height > largest_side) {
            throw Wrong{fmt::format("pass {} wants {}x{} pixels, a side has 1 to {}", pass.name,
                                    declared.width, declared.height, largest_side)};
        }
        // A compose function's pass has the chain's colour besides.
        const std::size_t most = pass.compose ? most_pass_inputs - 1 : most_pass_inputs;
        if (declared.input_count > most) {
            throw Wrong{
                fmt::format("pass {} reads {} textures, {} are sure", pass.name, declared.input_count, most)};
        }
        read_inputs_and_numbers(declared, pass);
        if (declared.output_count < 1 || declared.output_count > 8) {
            throw Wrong{fmt::format("pass {} has {} outputs", pass.name, declared.output_count)};
        }
        for (std::uint32_t i = 0; i < declared.output_count; ++i) {
            pass.formats.push_back(format(word_of(declared.formats[i]), pass.name));
        }
        if (declared.where != 0) {
            if (pass.compose) throw Wrong{"composes in tiles; only passes of an effect's own are drawn so"};
            const int mask = index(declared.where, fmt::format("pass {}: where", pass.name));
            const RecordedImage& image = recording_.images[mask];
            const int side = static_cast<int>(std::min<std::uint32_t>(declared.tile_side, largest_side));
            if (image.kind != RecordedImage::Kind::output) {
                throw Wrong{fmt::format("pass {}: a mask is an image that the effect made", pass.name)};
            }
            if (side < 1 || image.width != (pass.width + side - 1) / side
                || image.height != (pass.height + side - 1) / side) {
                throw Wrong{fmt::format("pass {}: a mask of {}x{} does not fit {}x{} pixels in tiles of {}",
                                        pass.name, image.width, image.height, pass.width, pass.height, side)};
            }
            pass.tile_side = side;
            // When everything is to run, that is how the mask is shown to be right.
            if (skip_ != Skip::nothing) pass.where = mask;
        }
        return add_pass(std::move(pass));
    }

    postfx_image add_pass(RecordedPass pass) {
        const int index = static_cast<int>(recording_.passes.size());
        postfx_image first = 0;
        for (std::size_t i = 0; i < pass.formats.size() && !pass.compose; ++i) {
            const postfx_image handle = add_image(
                {RecordedImage::Kind::output, "", index, static_cast<int>(i), pass.width, pass.height});
            if (i == 0) first = handle;
        }
        recording_.passes.push_back(std::move(pass));
        return first;
    }

    RecordedInput input(const postfx_input& declared, const std::string& pass) const {
        const std::string_view name = word_of(declared.name), filter = word_of(declared.filter);
        if (filter != "linear" && filter != "nearest") {
            throw Wrong{fmt::format("pass {}: {} has the unknown filter \"{}\"", pass, name, filter)};
        }
        return {std::string(name), index(declared.image, fmt::format("pass {}: {}", pass, name)),
                filter == "linear"};
    }

    static RecordedNumber number(const postfx_number& declared, const std::string& pass) {
        const std::string_view name = word_of(declared.name), kind = word_of(declared.kind);
        if ((kind != "float" && kind != "int") || declared.count < 1 || declared.count > 4) {
            throw Wrong{fmt::format("pass {}: {} has the unknown kind \"{}\" x {}", pass, name, kind,
                                    declared.count)};
        }
        RecordedNumber number{std::string(name), kind == "int", static_cast<int>(declared.count), {}};
        std::copy_n(declared.value, declared.count, number.value.begin());
        for (double value : number.value) {
            using Limits = std::numeric_limits<std::int32_t>;
            if (number.integer && !(value >= Limits::min() && value <= Limits::max())) {
                throw Wrong{fmt::format("pass {}: {} is {}, no 32-bit integer", pass, name, value)};
            }
        }
        return number;
    }

    Format format(std::string_view word, const std::string& pass) const {
        if (word.empty()) return working_format_;
        const auto found = format_by_name(word);
        if (!found || *found == Format::depth32f) {
            throw Wrong{fmt::format("pass {} has the unknown format \"{}\"", pass, word)};
        }
        return *found;
    }

    const ChainEntry& entry_;
    const SceneFacts& facts_;
    Format working_format_;
    Skip skip_;
    postfx_builder abi_{};
    Recording recording_;
    std::optional<Wrong> problem_;
};

std::vector<const char*> c_strings(const std::vector<std::string>& strings) {
    std::vector<const char*> pointers;
    for (const std::string& string : strings)
        pointers.push_back(string.c_str());
    return pointers;
}

postfx_camera abi_camera(const Camera& camera) {
    postfx_camera abi{};
    abi.struct_size = sizeof(abi);
    abi.orthographic = camera.orthographic;
    abi.tan_half_fov = camera.tan_half_fov();
    abi.vertical_extent = camera.vertical_extent;
    abi.near_plane = camera.near_plane;
    abi.far_plane = camera.far_plane;
    abi.depth_scale = camera.depth_scale;
    abi.depth_offset = camera.depth_offset;
    abi.sky_depth = camera.sky_depth;
    abi.focus_distance = camera.focus_distance;
    std::copy(camera.principal_point.begin(), camera.principal_point.end(), abi.principal_point);
    return abi;
}

/// A postfx_request with everything that it points to.
class AbiRequest {
public:
    AbiRequest(const ChainEntry& entry, const SceneFacts& facts, const Codes& codes)
        : camera_(abi_camera(facts.camera)), attachments_(c_strings(facts.attachments)),
          empty_(c_strings(facts.bounds.empty)) {
        scene_.struct_size = sizeof(scene_);
        scene_.nearest = facts.bounds.nearest;
        scene_.farthest = facts.bounds.farthest;
        scene_.reach = facts.bounds.reach;
        const double eye_height = facts.camera.view_to_world[13];
        scene_.lowest = std::min(facts.bounds.lowest, eye_height);
        scene_.highest = std::max(facts.bounds.highest, eye_height);
        scene_.empty = empty_.data();
        scene_.empty_count = static_cast<std::uint32_t>(empty_.size());
        request_.struct_size = sizeof(request_);
        request_.width = static_cast<std::uint32_t>(facts.width);
        request_.height = static_cast<std::uint32_t>(facts.height);
        request_.level = static_cast<std::uint32_t>(entry.level);
        request_.effect = entry.effect->abi;
        request_.values = entry.values.empty() ? nullptr : entry.values.front().data();
        request_.camera = &camera_;
        request_.attachments = attachments_.data();
        request_.attachment_count = static_cast<std::uint32_t>(attachments_.size());
        request_.scene = &scene_;
        request_.codes_per_light = codes.per_light;
        request_.codes_per_share = codes.per_share;
    }
    AbiRequest(const AbiRequest&) = delete;
    AbiRequest& operator=(const AbiRequest&) = delete;

    const postfx_request& get() const { return request_; }

private:
    postfx_camera camera_;
    std::vector<const char*> attachments_, empty_;
    postfx_scene scene_{};
    postfx_request request_{};
};

} // namespace

bool Recording::reads_color(const RecordedPass& pass) const {
    return std::any_of(pass.inputs.begin(), pass.inputs.end(), [&](const RecordedInput& input) {
        return images[input.image].kind == RecordedImage::Kind::color;
    });
}

Codes display_codes() {
    // sRGB is steepest at black, 12.92; relative to the light at white, 1.055 / 2.4.
    return {255 * 12.92, 255 * 1.055 / 2.4};
}

Codes codes_before(const ChainEntry& entry, const SceneFacts& facts, const Codes& behind) {
    postfx_gain gain{};
    gain.struct_size = sizeof(gain);
    constexpr double unknown = std::numeric_limits<double>::infinity();
    gain.share_to_share = gain.light_to_light = gain.share_to_light = unknown;
    if (entry.effect->gain) entry.effect->gain(&AbiRequest(entry, facts, behind).get(), &gain);
    const auto product = [](double a, double b) { return a == 0 || b == 0 ? 0 : a * b; };
    return {product(behind.per_light, gain.light_to_light),
            product(behind.per_share, gain.share_to_share) + product(behind.per_light, gain.share_to_light)};
}

Recording record(const ChainEntry& entry, const SceneFacts& facts, Format working_format, Skip skip,
                 const Codes& codes) {
    const AbiRequest request(entry, facts, codes);
    Recorder recorder(entry, facts, working_format, skip);
    const std::int32_t status = entry.effect->abi->plan(&request.get(), &recorder.abi());
    Recording recording = recorder.finish();
    if (status != 0)
        throw Error(Place{.effect = entry.name}, fmt::format("plan() failed with status {}", status));
    return recording;
}

} // namespace postfx
