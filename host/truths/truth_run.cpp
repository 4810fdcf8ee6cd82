#include "truth_run.hpp"

#include <base/read_file.hpp>
#include <image/files.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

namespace fs = std::filesystem;

namespace postfx::host {
namespace {

/// Of the file of sums; a change of what any truth sums up makes it another.
constexpr int file_version = 1;

/// Of what is read whole here: a scene's or model's file, a truth's sums.
constexpr std::size_t max_bytes = std::size_t{1} << 36;

/// FNV-1a, 64 bits: the same everywhere, which std::hash is not.
constexpr std::uint64_t hash_of_nothing = 0xcbf29ce484222325u;
std::uint64_t hash(const void* bytes, std::size_t count, std::uint64_t value = hash_of_nothing) {
    for (const auto* byte = static_cast<const unsigned char*>(bytes); count > 0; ++byte, --count)
        value = (value ^ *byte) * 0x100000001b3u;
    return value;
}

/// The scene's text and its meshes, which models and generators make that the text only names.
std::string scene_key(const Scene& scene) {
    const bool has_file = scene.content.empty() && fs::is_regular_file(scene.file);
    const std::string text = has_file ? read_file(scene.file, max_bytes, "a scene") : scene.content;
    std::uint64_t value = hash(text.data(), text.size());
    std::set<const Mesh*> meshes;
    for (const Node& node : scene.nodes) {
        for (const Part& part : node.parts) {
            const Mesh& mesh = *part.mesh;
            if (!meshes.insert(&mesh).second) continue;
            value = hash(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vertex), value);
            value = hash(mesh.indices.data(), mesh.indices.size() * sizeof(std::uint32_t), value);
        }
    }
    return fmt::format("{} {:016x}", scene.name, value);
}
static_assert(sizeof(Vertex) == 11 * sizeof(float), "bytes of a vertex that mean nothing would be hashed");

double root_mean_square(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value * value;
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
}

} // namespace

TruthRun::TruthRun(const RegisteredTruth& registered, const TruthRequest& request, int samples)
    : title_(fmt::format("{}-{}-{}-{}x{}-{}", request.scene.name, registered.effect, registered.kind,
                         request.width, request.height, samples)),
      samples_(samples) {
    if (samples < 2 || samples % 2 != 0)
        throw Error(
            fmt::format("{} samples can't be split in two halves; expected an even number from 2", samples));
    if (request.given && !registered.takes_given)
        throw Error(
            Place{.effect = registered.effect},
            fmt::format("the truth of kind \"{}\" draws the scene itself and can't be of a given picture",
                        registered.kind));
    truth_ = registered.make(request);
    key_ =
        fmt::format("{} {} of {} at {} s, frame {}, {}x{}, {} per pixel, {} samples: {}", registered.effect,
                    registered.kind, scene_key(request.scene), request.time, request.frame, request.width,
                    request.height, request.scene_samples, samples, truth_->values());
    if (request.given) {
        const std::vector<double>& light = request.given->values;
        key_ += fmt::format(", given {:016x}", hash(light.data(), light.size() * sizeof(double)));
    }
    halves_.fill(Image64(request.width, request.height, truth_->channels()));
}

void TruthRun::step() {
    Image64& half = halves_[static_cast<std::size_t>(done_ % 2)];
    truth_->add(done_, half);
    ++done_;
    const bool finite = std::all_of(half.values.begin(), half.values.end(),
                                    [](double value) { return std::isfinite(value); });
    if (!finite) throw Error(fmt::format("sample {} of the truth has light that is not finite", done_));
}

TruthResult TruthRun::result() const {
    const auto [even, odd] = halves_;
    const int even_count = (done_ + 1) / 2, odd_count = done_ / 2;
    Image64 whole = even;
    for (std::size_t i = 0; i < whole.values.size(); ++i)
        whole.values[i] += odd.values[i];
    TruthResult result{.picture = truth_->picture(whole, done_),
                       .samples = done_,
                       .description = truth_->description(done_)};
    result.root_mean_square = root_mean_square(result.picture.values);
    if (odd_count == 0) {
        result.own_error = std::numeric_limits<double>::infinity();
        return result;
    }
    std::vector<double> apart = truth_->picture(even, even_count).values;
    const Image64 other = truth_->picture(odd, odd_count);
    for (std::size_t i = 0; i < apart.size(); ++i)
        apart[i] -= other.values[i];
    // Independent halves of variance s/n0 and s/n1 are s (1/n0 + 1/n1) apart; the whole has s / (n0 + n1).
    const double scale = std::sqrt(static_cast<double>(even_count) * odd_count) / done_;
    const double error = scale * root_mean_square(apart);
    result.own_error = error == 0 ? 0 : error / result.root_mean_square;
    return result;
}

std::string TruthRun::file_name() const {
    return fmt::format("{}-{:016x}.sums", title_, hash(key_.data(), key_.size()));
}

void TruthRun::save(const fs::path& file) const {
    const nlohmann::ordered_json header = {
        {"postfx_truth", file_version}, {"key", key_}, {"done", done_}, {"channels", halves_[0].channels}};
    std::string bytes = header.dump() + "\n";
    for (const Image64& half : halves_) {
        bytes.append(reinterpret_cast<const char*>(half.values.data()), half.values.size() * sizeof(double));
    }
    write_file_atomically(file, bytes);
}

bool TruthRun::resume(const fs::path& file) {
    if (!fs::exists(file)) return false;
    const Place place{.file = file.string()};
    const std::string bytes = read_file(file, max_bytes, "a truth's sums");
    const std::size_t line_end = bytes.find('\n');
    const auto header = nlohmann::json::parse(bytes.substr(0, line_end), nullptr, false);
    if (line_end == std::string::npos || !header.is_object())
        throw Error(place, "not a file of a truth's sums; expected a first line of JSON");
    if (header.value("postfx_truth", 0) != file_version || header.value("key", "") != key_) return false;
    const std::size_t half_bytes = halves_[0].values.size() * sizeof(double);
    const int done = header.value("done", -1);
    if (bytes.size() != line_end + 1 + 2 * half_bytes || done < 0 || done > samples_)
        throw Error(place, fmt::format("damaged: {} bytes after the first line, expected {}",
                                       bytes.size() - line_end - 1, 2 * half_bytes));
    const char* from = bytes.data() + line_end + 1;
    for (Image64& half : halves_) {
        std::copy_n(from, half_bytes, reinterpret_cast<char*>(half.values.data()));
        from += half_bytes;
    }
    done_ = done;
    return true;
}

} // namespace postfx::host
