#include <image/exr_file.hpp>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiView.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTileDescription.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace postfx::formats {
namespace {

/// Rows that are decoded at once: the library's largest block, that of DWAB.
constexpr long long block_rows = 256;

ExrPart part_of(const Imf::Header& header) {
    ExrPart part;
    if (header.hasName()) part.name = header.name();
    if (header.hasView()) part.view = header.view();
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
        const Imf::Channel& channel = i.channel();
        part.channels.push_back(
            {i.name(), type_name(channel.type), channel.xSampling != 1 || channel.ySampling != 1});
    }
    return part;
}

/// Cryptomatte 1.2: an attribute "cryptomatte/<id>/name" holds what its layers' names begin with.
void add_mattes(const Imf::Header& header, std::set<std::string>& names) {
    for (auto i = header.begin(); i != header.end(); ++i) {
        const std::string_view attribute = i.name();
        if (!attribute.starts_with("cryptomatte/") || !attribute.ends_with("/name")) continue;
        const auto* name = dynamic_cast<const Imf::StringAttribute*>(&i.attribute());
        if (name && !name->value().empty()) names.insert(name->value());
    }
}

/// Copies the pixels of one part that the display window shows.
class PartReader {
public:
    PartReader(Imf::InputPart part, const ExrWindow& display, const ExrLayer& layer)
        : part_(part), box_(part.header().dataWindow()), data_(window_of(box_)), display_(display) {
        for (std::size_t i = 0; i < layer.channels.size(); ++i)
            if (part.header().channels().findChannel(layer.channels[i]))
                wanted_.push_back({layer.channels[i], static_cast<int>(i)});
    }

    void read_into(Image& image) {
        const long long begin = std::max(data_.y, display_.y);
        const long long end = std::min(data_.y_end(), display_.y_end());
        for (long long y = begin; y < end && !wanted_.empty(); y += block_rows)
            read_rows(static_cast<int>(y), static_cast<int>(std::min(y + block_rows, end)), image);
    }

private:
    struct Wanted {
        std::string name;
        int index; ///< which channel of the image it becomes
    };

    void read_rows(int begin, int end, Image& image) {
        const std::size_t channels = wanted_.size();
        const Imath::Box2i block({box_.min.x, begin}, {box_.max.x, end - 1});
        std::vector<float> pixels(static_cast<std::size_t>(data_.width) * (end - begin) * channels);
        Imf::FrameBuffer frame;
        for (std::size_t i = 0; i < channels; ++i)
            frame.insert(wanted_[i].name,
                         Imf::Slice::Make(Imf::FLOAT, pixels.data() + i, block, channels * sizeof(float)));
        part_.setFrameBuffer(frame);
        part_.readPixels(begin, end - 1);
        for (int y = begin; y < end; ++y)
            copy_row(pixels.data() + static_cast<std::size_t>(y - begin) * data_.width * channels, y, image);
    }

    void copy_row(const float* row, int y, Image& image) const {
        const long long begin = std::max(data_.x, display_.x),
                        end = std::min(data_.x_end(), display_.x_end());
        const int to_y = static_cast<int>(display_.height - 1 - (y - display_.y));
        for (long long x = begin; x < end; ++x) {
            const float* from = row + static_cast<std::size_t>(x - data_.x) * wanted_.size();
            for (const Wanted& channel : wanted_)
                image.at(static_cast<int>(x - display_.x), to_y, channel.index) = *from++;
        }
    }

    Imf::InputPart part_;
    Imath::Box2i box_;
    ExrWindow data_;
    const ExrWindow& display_;
    std::vector<Wanted> wanted_;
};

} // namespace

bool ExrStream::read(char to[], int count) {
    const auto wanted = static_cast<std::size_t>(count);
    if (count < 0 || at_ > bytes_.size() || bytes_.size() - at_ < wanted)
        throw std::runtime_error("unexpected end of file");
    std::memcpy(to, bytes_.data() + at_, wanted);
    at_ += wanted;
    return at_ < bytes_.size();
}

ExrWindow window_of(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, 1LL + box.max.x - box.min.x, 1LL + box.max.y - box.min.y};
}

const char* type_name(Imf::PixelType type) {
    return type == Imf::HALF ? "half" : type == Imf::FLOAT ? "float" : "uint";
}

ExrFile::ExrFile(const ImageSource& source) : source_(source), stream_(source.bytes), input_(stream_) {
    std::vector<ExrPart> names;
    std::vector<std::string> views;
    std::set<std::string> mattes;
    for (int part = 0; part < parts(); ++part) {
        names.push_back(part_of(header(part)));
        if (is_deep(part)) names.back().channels.clear();
        if (views.empty() && Imf::hasMultiView(header(part))) views = Imf::multiView(header(part));
        add_mattes(header(part), mattes);
    }
    display_ = window_of(header(0).displayWindow());
    contents_ = contents_of(names, views, mattes);
}

bool ExrFile::is_deep(int part) const {
    return header(part).hasType() && Imf::isDeepData(header(part).type());
}

std::string ExrFile::called(int part) const {
    return parts() > 1 ? fmt::format("part {} ", part + 1) : "";
}

void ExrFile::check_part(int part) const {
    const Imf::Header& header = this->header(part);
    check_size(source_.name, display_.width, display_.height);
    check_plausible(source_, display_.width * display_.height);
    const ExrWindow data = window_of(header.dataWindow());
    check_size(source_.name, data.width, data.height);
    long long at_once = data.width * block_rows;
    if (header.hasTileDescription()) {
        const Imf::TileDescription& tile = header.tileDescription();
        check_size(source_.name, tile.xSize, tile.ySize);
        at_once = std::max(data.width, static_cast<long long>(tile.xSize)) * tile.ySize;
    }
    // The library unpacks all channels of a block together.
    long long channels = 0;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
        ++channels;
    check_plausible(source_, at_once * channels);
    if (!input_.partComplete(part))
        fail(source_.name, called(part) + "truncated: not all of its pixels were written");
}

void ExrFile::check_readable(const ExrLayer& layer) const {
    check_part(layer.part);
    for (const std::string& name : layer.channels) {
        const Imf::Channel* channel = header(layer.part).channels().findChannel(name);
        if (channel && layer.shape != ExrLayer::Shape::luminance_chroma
            && (channel->xSampling != 1 || channel->ySampling != 1))
            fail(source_.name,
                 fmt::format("its channel {} is subsampled; write it at full resolution", name));
    }
}

Image ExrFile::read(const ExrLayer& layer) {
    check_readable(layer);
    if (layer.shape == ExrLayer::Shape::luminance_chroma) return read_luminance_chroma(layer);
    Image image(static_cast<int>(display_.width), static_cast<int>(display_.height),
                static_cast<int>(layer.channels.size()));
    PartReader(Imf::InputPart(input_, layer.part), display_, layer).read_into(image);
    return image;
}

Image ExrFile::read_luminance_chroma(const ExrLayer& layer) {
    if (parts() > 1)
        fail(source_.name,
             "its picture is luminance and chroma in one of several parts, which can't be read; "
             "write it as R, G, B");
    ExrStream stream(source_.bytes);
    Imf::RgbaInputFile input(stream, layer.path);
    const Imath::Box2i box = input.dataWindow();
    const ExrWindow data = window_of(box);
    std::vector<Imf::Rgba> pixels(static_cast<std::size_t>(data.width) * data.height);
    input.setFrameBuffer(Imf::ComputeBasePointer(pixels.data(), box), 1,
                         static_cast<std::size_t>(data.width));
    input.readPixels(box.min.y, box.max.y);
    Image image(static_cast<int>(display_.width), static_cast<int>(display_.height), layer.has_alpha ? 4 : 3);
    for (long long y = std::max(data.y, display_.y); y < std::min(data.y_end(), display_.y_end()); ++y)
        for (long long x = std::max(data.x, display_.x); x < std::min(data.x_end(), display_.x_end()); ++x) {
            const Imf::Rgba& from = pixels[static_cast<std::size_t>((y - data.y) * data.width + x - data.x)];
            float* to = image.pixel(static_cast<int>(x - display_.x),
                                    static_cast<int>(display_.height - 1 - (y - display_.y)));
            const float values[4] = {from.r, from.g, from.b, from.a};
            std::copy_n(values, image.channels, to);
        }
    return image;
}

} // namespace postfx::formats
