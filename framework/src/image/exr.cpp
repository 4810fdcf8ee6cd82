// OpenEXR, by the library. Its exceptions end here.
#include <image/exr_layers.hpp>
#include <image/formats.hpp>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiView.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfTileDescription.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace postfx::formats {
namespace {

/// Run `work`; what the library throws becomes a one-line Error.
template<class Work>
auto with_errors_translated(const Path& file, const char* doing, Work work) -> decltype(work()) {
    try {
        return work();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        std::string reason = error.what();
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        fail(file, fmt::format("{} ({})", doing, reason));
    }
}

/// Bytes in memory as the library reads them, without the copy that its own StdISStream makes.
class MemoryStream : public Imf::IStream {
public:
    explicit MemoryStream(std::string_view bytes) : IStream("EXR"), bytes_(bytes) {}

    bool isMemoryMapped() const override { return false; }
    bool read(char to[], int count) override {
        const auto wanted = static_cast<std::size_t>(count);
        if (count < 0 || at_ > bytes_.size() || bytes_.size() - at_ < wanted)
            throw std::runtime_error("unexpected end of file");
        std::memcpy(to, bytes_.data() + at_, wanted);
        at_ += wanted;
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override { at_ = position; }
    void clear() override {}

private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

struct Window {
    long long x = 0, y = 0, width = 0, height = 0;
};

Window window_of(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, 1LL + box.max.x - box.min.x, 1LL + box.max.y - box.min.y};
}

/// All parts of a file as one set of channels. A later part's channel whose name is taken gets its part's
/// view or name as prefix ("right.R").
class ExrFile {
public:
    ExrFile(const Path& file, const std::string& bytes) : file_(file), stream_(bytes), input_(stream_) {
        display_ = window_of(input_.header(0).displayWindow());
        check_size(file_, display_.width, display_.height);
        for (int part = 0; part < input_.parts(); ++part)
            add_part(part);
    }

    const std::vector<std::string>& names() const { return names_; }
    /// Names of the stereo views, the default one first; often empty.
    std::vector<std::string> views() const {
        const Imf::Header& header = input_.header(0);
        return Imf::hasMultiView(header) ? Imf::multiView(header) : std::vector<std::string>{};
    }
    /// The display window, once for each list of channels; 0 where the file has nothing. All in one go, because the
    /// library unpacks all channels of a row together.
    std::vector<Image> read_all(const std::vector<std::vector<std::string>>& lists) {
        std::vector<Image> images;
        std::vector<std::vector<Wanted>> wanted(static_cast<std::size_t>(input_.parts()));
        for (const std::vector<std::string>& names : lists) {
            for (std::size_t i = 0; i < names.size(); ++i)
                if (const auto found = sources_.find(names[i]); found != sources_.end())
                    wanted[found->second.part].push_back(
                        {found->second.channel, images.size(), static_cast<int>(i)});
            images.emplace_back(static_cast<int>(display_.width), static_cast<int>(display_.height),
                                static_cast<int>(names.size()));
        }
        for (int part = 0; part < input_.parts(); ++part)
            if (!wanted[part].empty()) read_part(part, wanted[part], images);
        return images;
    }
    Image read(const std::vector<std::string>& names) { return std::move(read_all({names}).front()); }

private:
    struct Source {
        int part = 0;
        std::string channel; ///< its name in the part
    };
    struct Wanted {
        std::string channel;   ///< its name in the part
        std::size_t image = 0; ///< which image it belongs to
        int index = 0;         ///< which channel of that image it becomes
    };

    void add_part(int part) {
        const Imf::Header& header = input_.header(part);
        const std::string called = input_.parts() > 1 ? fmt::format("part {} ", part + 1) : "";
        if (header.hasType() && Imf::isDeepData(header.type()))
            fail(file_, called + "holds deep data, which has no single value per pixel; flatten it first");
        const Window data = window_of(header.dataWindow());
        check_size(file_, data.width, data.height);
        if (header.hasTileDescription())
            check_size(file_, header.tileDescription().xSize, header.tileDescription().ySize);
        if (!input_.partComplete(part)) fail(file_, called + "truncated: not all of its pixels were written");

        for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
            if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
                fail(file_, fmt::format("its channel {} is subsampled; write it at full resolution",
                                        channel.name()));
            std::string name = channel.name();
            if (sources_.contains(name)) name.insert(0, part_prefix(header, part) + ".");
            if (sources_.emplace(name, Source{part, channel.name()}).second) names_.push_back(name);
        }
    }

    static std::string part_prefix(const Imf::Header& header, int part) {
        if (header.hasView()) return header.view();
        return header.hasName() ? header.name() : fmt::format("part{}", part + 1);
    }

    void read_part(int part, const std::vector<Wanted>& wanted, std::vector<Image>& images) {
        const Imath::Box2i& box = input_.header(part).dataWindow();
        const Window data = window_of(box);
        Image pixels(static_cast<int>(data.width), static_cast<int>(data.height),
                     static_cast<int>(wanted.size()));
        Imf::FrameBuffer frame;
        const std::size_t x_stride = wanted.size() * sizeof(float);
        for (std::size_t i = 0; i < wanted.size(); ++i)
            frame.insert(wanted[i].channel,
                         Imf::Slice::Make(Imf::FLOAT, pixels.values.data() + i, box, x_stride));
        Imf::InputPart input(input_, part);
        input.setFrameBuffer(frame);
        input.readPixels(box.min.y, box.max.y);

        // What lies in both windows; `pixels` counts its rows from the top.
        const long long x_begin = std::max(data.x, display_.x);
        const long long x_end = std::min(data.x + data.width, display_.x + display_.width);
        const long long y_begin = std::max(data.y, display_.y);
        const long long y_end = std::min(data.y + data.height, display_.y + display_.height);
        for (long long y = y_begin; y < y_end; ++y)
            for (long long x = x_begin; x < x_end; ++x) {
                const float* from = pixels.pixel(static_cast<int>(x - data.x), static_cast<int>(y - data.y));
                const int to_x = static_cast<int>(x - display_.x);
                const int to_y = static_cast<int>(display_.height - 1 - (y - display_.y));
                for (const Wanted& channel : wanted)
                    images[channel.image].at(to_x, to_y, channel.index) = *from++;
            }
    }

    const Path& file_;
    MemoryStream stream_;
    Imf::MultiPartInputFile input_;
    Window display_;
    std::map<std::string, Source> sources_;
    std::vector<std::string> names_;
};

constexpr const char* reading = "truncated or damaged EXR";

bool recognises_exr(std::string_view bytes) {
    return bytes.starts_with("\x76\x2f\x31\x01");
}

/// The layer that is asked for by name.
Layers::value_type named_layer(const Path& file, const ExrFile& exr, const Layers& layers,
                               const std::string& name) {
    if (const auto found = layers.find(name); found != layers.end()) return *found;
    if (std::count(exr.names().begin(), exr.names().end(), name)) return {name, {name}};
    std::vector<std::string> candidates = exr.names();
    for (const auto& [layer, channels] : layers)
        if (!layer.empty()) candidates.push_back(layer);
    fail(file, fmt::format("has no layer or channel \"{}\"{} (it has {})", name,
                           did_you_mean(name, candidates), fmt::join(exr.names(), ", ")));
}

Layers::value_type layer_for(const Path& file, const ExrFile& exr, const ImageRequest& request) {
    const Layers layers = group_channels(exr.names());
    if (!request.layer.empty()) return named_layer(file, exr, layers, request.layer);
    const auto* found = request.role == Role::depth ? depth_layer(layers) : nullptr;
    if (!found) found = main_layer(layers, exr.views());
    if (!found)
        fail(file, fmt::format("has no {}; its channels are {}", name_of(request.role),
                               fmt::join(exr.names(), ", ")));
    return *found;
}

ImageFile read_exr(const ImageSource& source, const ImageRequest& request) {
    return with_errors_translated(source.name, reading, [&] {
        ExrFile exr(source.name, source.bytes);
        const Layers::value_type layer = layer_for(source.name, exr, request);
        ImageFile file;
        file.image = exr.read(layer.second);
        file.layer = layer.first;
        return file;
    });
}

ImageDescription describe_exr(const ImageSource& source) {
    return with_errors_translated(source.name, reading, [&] {
        const ExrFile exr(source.name, source.bytes);
        ImageDescription description{.kind = formats::exr.name, .views = exr.views()};
        return description;
    });
}

} // namespace

const Format exr = {"OpenEXR", recognises_exr, read_exr, describe_exr};

std::string exr_bytes(const Path& file, const Image& image, bool half_floats) {
    static const char* const names[5][4] = {{}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    return with_errors_translated(file, "no EXR could be made", [&] {
        const Imf::PixelType type = half_floats ? Imf::HALF : Imf::FLOAT;
        const Image rows = upside_down(image);
        std::vector<half> halves;
        if (half_floats) halves.assign(rows.values.begin(), rows.values.end());
        const char* pixels = half_floats ? reinterpret_cast<const char*>(halves.data())
                                         : reinterpret_cast<const char*>(rows.values.data());
        const std::size_t number = half_floats ? sizeof(half) : sizeof(float);
        const auto channels = static_cast<std::size_t>(image.channels);

        Imf::Header header(image.width, image.height);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer frame;
        for (std::size_t channel = 0; channel < channels; ++channel) {
            const char* name = names[channels][channel];
            header.channels().insert(name, Imf::Channel(type));
            frame.insert(name, Imf::Slice::Make(type, pixels + channel * number, header.dataWindow(),
                                                channels * number));
        }
        Imf::StdOSStream stream;
        {
            Imf::OutputFile output(stream, header); // its destructor writes the table of rows
            output.setFrameBuffer(frame);
            output.writePixels(image.height);
        }
        return stream.str();
    });
}

} // namespace postfx::formats
