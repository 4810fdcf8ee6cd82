// OpenEXR: a picture back in the file that it was taken from. Parts that have not changed are copied as they are packed; of
// the part with the picture only the pixels that differ get other numbers.
#include <image/exr_attributes.hpp>
#include <image/exr_file.hpp>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfDeepScanLineInputPart.h>
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfDeepTiledInputPart.h>
#include <OpenEXR/ImfDeepTiledOutputPart.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledInputPart.h>
#include <OpenEXR/ImfTiledOutputPart.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

namespace postfx::formats {
namespace {

using Rgba = std::array<float, 4>;

/// Grey is repeated; without alpha it is 1.
Rgba pixel_of(const Image& image, int x, int y) {
    const float* from = image.pixel(x, y);
    const bool grey = image.channels < 3, alpha = image.channels % 2 == 0;
    return {from[0], from[grey ? 0 : 1], from[grey ? 0 : 2], alpha ? from[image.channels - 1] : 1.0f};
}

/// What the chain made of a picture, in the colour space and by the rows of its file.
class Change {
public:
    /// `before`: as it was read; `after`: as it is to be written, of the same size.
    Change(const Image& before, const Image& after, const ExrWindow& display,
           const std::optional<ColorMatrix>& to_rec709)
        : before_(before), after_(after), in_file_(after), display_(display) {
        if (to_rec709) convert_colors(in_file_, inverse(*to_rec709).value());
        for (int y = 0; y < after.height; ++y)
            for (int x = 0; x < after.width; ++x)
                if (differs(x, y)) note(x, y);
    }

    bool any() const { return any_; }
    /// Did grey become colour?
    bool colored() const { return colored_; }
    /// What is not black among the pixels that changed; y counts from the top, as in the file. Empty if there are none.
    const Imath::Box2i& lit() const { return lit_; }

    /// In the display window, and not as it was read?
    bool at(int x, int y) const {
        return x >= display_.x && y >= display_.y && x < display_.x_end() && y < display_.y_end()
               && differs(column(x), row(y));
    }
    /// In the file's colour space; nothing outside of the display window.
    Rgba value(int x, int y) const {
        if (x < display_.x || y < display_.y || x >= display_.x_end() || y >= display_.y_end()) return {};
        return pixel_of(in_file_, column(x), row(y));
    }

private:
    int column(int x) const { return static_cast<int>(x - display_.x); }
    int row(int y) const { return static_cast<int>(display_.height - 1 - (y - display_.y)); }

    /// A picture that is written without alpha leaves the file's as it is.
    bool differs(int x, int y) const {
        const Rgba a = pixel_of(before_, x, y), b = pixel_of(after_, x, y);
        const bool alpha = after_.channels % 2 == 0;
        return std::memcmp(a.data(), b.data(), (alpha ? 4 : 3) * sizeof(float)) != 0;
    }

    void note(int x, int y) {
        any_ = true;
        const Rgba pixel = pixel_of(after_, x, y);
        colored_ = colored_ || pixel[0] != pixel[1] || pixel[0] != pixel[2];
        const bool black = pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 0;
        if (!black)
            lit_.extendBy(Imath::V2i(static_cast<int>(x + display_.x),
                                     static_cast<int>(display_.y + display_.height - 1 - y)));
    }

    const Image& before_;
    const Image& after_;
    Image in_file_; ///< `after` in the colour space of the file
    const ExrWindow& display_;
    Imath::Box2i lit_;
    bool any_ = false, colored_ = false;
};

/// A channel that gets numbers of the picture.
struct Target {
    std::string name;
    std::size_t component; ///< 0 to 3
};

bool loses_bits(Imf::Compression compression) {
    return compression == Imf::B44_COMPRESSION || compression == Imf::B44A_COMPRESSION
           || compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
}

/// Writes the part with the picture again.
class PartWriter {
public:
    PartWriter(ExrFile& in, const ExrLayer& layer, const Change& change, std::vector<std::string>& remarks)
        : in_(in), layer_(layer), change_(change), remarks_(remarks), header_(in.header(layer.part)) {
        choose_channels();
        choose_window();
        choose_coding();
    }

    const Imf::Header& header() const { return header_; }

    void write(Imf::MultiPartOutputFile& file, int part) {
        const Imath::Box2i window = header_.dataWindow();
        const int rows = block_rows();
        const int blocks = (window.max.y - window.min.y) / rows + 1;
        const bool upwards = !header_.hasTileDescription() && header_.lineOrder() == Imf::DECREASING_Y;
        Imf::InputPart input(in_.input(), layer_.part);
        std::optional<Imf::OutputPart> lines;
        std::optional<Imf::TiledOutputPart> tiles;
        if (header_.hasTileDescription())
            tiles.emplace(file, part);
        else
            lines.emplace(file, part);
        for (int i = 0; i < blocks; ++i) {
            const int first = window.min.y + (upwards ? blocks - 1 - i : i) * rows;
            Block block(header_, first, std::min(first + rows - 1, window.max.y));
            block.read(input);
            replace(block);
            if (lines)
                block.write(*lines);
            else
                block.write(*tiles,
                            (first - window.min.y) / static_cast<int>(header_.tileDescription().ySize));
        }
        if (overflows_ > 0)
            remarks_.push_back(
                fmt::format("{} values beyond 65504 became infinite: its channels are half", overflows_));
    }

private:
    /// Some rows of all channels, in the types that they have in the file.
    class Block {
    public:
        Block(const Imf::Header& header, int first, int last)
            : box_({header.dataWindow().min.x, first}, {header.dataWindow().max.x, last}) {
            for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
                add(i.name(), i.channel());
        }

        const Imath::Box2i& box() const { return box_; }
        char* pixel(const std::string& channel, int x, int y) {
            const Imf::Slice& slice = *frame_.findSlice(channel);
            return slice.base + static_cast<std::ptrdiff_t>(slice.xStride) * x
                   + static_cast<std::ptrdiff_t>(slice.yStride) * y;
        }
        /// What the file has of these rows.
        void read(Imf::InputPart& input) {
            const Imath::Box2i& data = input.header().dataWindow();
            const int begin = std::max(box_.min.y, data.min.y), end = std::min(box_.max.y, data.max.y);
            if (begin > end) return;
            Imf::FrameBuffer there;
            for (auto i = frame_.begin(); i != frame_.end(); ++i)
                if (input.header().channels().findChannel(i.name())) there.insert(i.name(), i.slice());
            input.setFrameBuffer(there);
            input.readPixels(begin, end);
        }
        void write(Imf::OutputPart& output) const {
            output.setFrameBuffer(frame_);
            output.writePixels(box_.max.y - box_.min.y + 1);
        }
        void write(Imf::TiledOutputPart& output, int first_row_of_tiles) const {
            const int height = static_cast<int>(output.tileYSize());
            const int last = first_row_of_tiles + (box_.max.y - box_.min.y) / height;
            output.setFrameBuffer(frame_);
            output.writeTiles(0, output.numXTiles() - 1, first_row_of_tiles, last);
        }

    private:
        void add(const std::string& name, const Imf::Channel& channel) {
            const std::size_t number = channel.type == Imf::HALF ? 2 : 4;
            const auto width = static_cast<std::size_t>(box_.max.x - box_.min.x) / channel.xSampling + 1;
            const auto height = static_cast<std::size_t>(box_.max.y - box_.min.y) / channel.ySampling + 1;
            memory_.emplace_back(number * width * height);
            frame_.insert(name, Imf::Slice::Make(channel.type, memory_.back().data(), box_, number,
                                                 number * width, channel.xSampling, channel.ySampling));
        }

        Imath::Box2i box_;
        std::vector<std::vector<char>> memory_;
        Imf::FrameBuffer frame_;
    };

    /// Grey that became colour gets channels for it, and so does a colour that the file does not have.
    void choose_channels() {
        const bool colors = layer_.shape == ExrLayer::Shape::color || layer_.shape == ExrLayer::Shape::vector;
        const std::size_t count = layer_.channels.size() - (layer_.has_alpha ? 1 : 0);
        if (colors || (count == 1 && !change_.colored())) {
            for (std::size_t i = 0; i < count; ++i)
                targets_.push_back({layer_.channels[i], i});
        } else {
            exchange_channels();
        }
        if (layer_.has_alpha) targets_.push_back({layer_.channels.back(), 3});
        for (const Target& target : targets_)
            if (!header_.channels().findChannel(target.name))
                header_.channels().insert(target.name, Imf::Channel(type_of_layer()));
    }

    void exchange_channels() {
        const std::string prefix = before_last_dot(layer_.channels.front());
        const Imf::PixelType type = type_of_layer();
        const std::size_t count = layer_.channels.size() - (layer_.has_alpha ? 1 : 0);
        Imf::ChannelList kept;
        for (auto i = header_.channels().begin(); i != header_.channels().end(); ++i)
            if (std::find(layer_.channels.begin(),
                          layer_.channels.begin() + static_cast<std::ptrdiff_t>(count), i.name())
                == layer_.channels.begin() + static_cast<std::ptrdiff_t>(count))
                kept.insert(i.name(), i.channel());
        for (const auto& [name, component] : {std::pair{"R", 0}, std::pair{"G", 1}, std::pair{"B", 2}}) {
            const std::string full = prefix.empty() ? name : prefix + "." + name;
            kept.insert(full, Imf::Channel(type));
            targets_.push_back({full, static_cast<std::size_t>(component)});
        }
        header_.channels() = kept;
        remarks_.push_back(fmt::format("\"{}\" became red, green and blue: its picture has colours now",
                                       fmt::join(layer_.channels, ", ")));
    }

    Imf::PixelType type_of_layer() const {
        for (const std::string& name : layer_.channels)
            if (const Imf::Channel* channel = in_.header(layer_.part).channels().findChannel(name))
                return channel->type;
        return Imf::HALF;
    }

    /// Light that effects put beside the data needs a larger window.
    void choose_window() {
        Imath::Box2i window = header_.dataWindow();
        if (change_.lit().isEmpty()) return;
        window.extendBy(change_.lit());
        if (window == header_.dataWindow()) return;
        for (auto i = header_.channels().begin(); i != header_.channels().end(); ++i)
            if (i.channel().xSampling != 1 || i.channel().ySampling != 1) {
                remarks_.push_back(
                    "light beside the data window was cut off: its subsampled channels fix the window");
                return;
            }
        header_.dataWindow() = window;
        remarks_.push_back(fmt::format("the data window grew to {} {} to {} {}, where the chain put light",
                                       window.min.x, window.min.y, window.max.x, window.max.y));
    }

    void choose_coding() {
        if (loses_bits(header_.compression())) {
            header_.compression() = Imf::ZIP_COMPRESSION;
            remarks_.emplace_back(
                "the part with the picture is packed with ZIP now: its compression would change "
                "what the chain did not");
        }
        if (header_.hasTileDescription() && header_.tileDescription().mode != Imf::ONE_LEVEL) {
            header_.tileDescription().mode = Imf::ONE_LEVEL;
            remarks_.emplace_back("smaller levels of the picture were left out");
        }
        if (header_.hasPreviewImage()) {
            header_.erase("preview");
            remarks_.emplace_back("the preview was left out: it showed the picture as it was");
        }
    }

    /// Whole rows of tiles, and whole blocks of every compression.
    int block_rows() const {
        constexpr int rows = 256;
        if (!header_.hasTileDescription()) return rows;
        const int tile = static_cast<int>(header_.tileDescription().ySize);
        return tile * std::max(1, rows / tile);
    }

    void replace(Block& block) {
        for (const Target& target : targets_) {
            const Imf::PixelType type = header_.channels().findChannel(target.name)->type;
            const bool is_new = !in_.header(layer_.part).channels().findChannel(target.name);
            for (int y = block.box().min.y; y <= block.box().max.y; ++y)
                for (int x = block.box().min.x; x <= block.box().max.x; ++x)
                    if (is_new || change_.at(x, y))
                        put(change_.value(x, y)[target.component], type, block.pixel(target.name, x, y));
        }
    }

    void put(float value, Imf::PixelType type, char* to) {
        if (type == Imf::FLOAT) {
            std::memcpy(to, &value, sizeof value);
            return;
        }
        if (type == Imf::UINT) {
            const double largest = std::numeric_limits<std::uint32_t>::max();
            const auto whole =
                static_cast<std::uint32_t>(value > 0 ? std::min(std::round(double(value)), largest) : 0);
            std::memcpy(to, &whole, sizeof whole);
            return;
        }
        const half rounded(value);
        if (rounded.isInfinity() && std::isfinite(value)) ++overflows_;
        std::memcpy(to, &rounded, sizeof rounded);
    }

    ExrFile& in_;
    const ExrLayer& layer_;
    const Change& change_;
    std::vector<std::string>& remarks_;
    Imf::Header header_;
    std::vector<Target> targets_;
    std::size_t overflows_ = 0;
};

/// A part as it is packed.
void copy_part(Imf::MultiPartInputFile& in, int from, Imf::MultiPartOutputFile& out, int to) {
    const Imf::Header& header = in.header(from);
    const std::string type = header.hasType()              ? header.type()
                             : header.hasTileDescription() ? Imf::TILEDIMAGE
                                                           : Imf::SCANLINEIMAGE;
    if (type == Imf::DEEPSCANLINE) {
        Imf::DeepScanLineInputPart input(in, from);
        Imf::DeepScanLineOutputPart(out, to).copyPixels(input);
    } else if (type == Imf::DEEPTILE) {
        Imf::DeepTiledInputPart input(in, from);
        Imf::DeepTiledOutputPart(out, to).copyPixels(input);
    } else if (type == Imf::TILEDIMAGE) {
        Imf::TiledInputPart input(in, from);
        Imf::TiledOutputPart(out, to).copyPixels(input);
    } else {
        Imf::InputPart input(in, from);
        Imf::OutputPart(out, to).copyPixels(input);
    }
}

/// All parts that are whole.
std::vector<int> parts_to_carry(ExrFile& exr, std::vector<std::string>& remarks) {
    std::vector<int> parts;
    for (int part = 0; part < exr.parts(); ++part)
        if (exr.input().partComplete(part))
            parts.push_back(part);
        else
            remarks.push_back(exr.called(part) + "is truncated and was left out");
    return parts;
}

} // namespace

std::string exr_bytes_carrying(const Path& file, const Image& image, const Origin& origin,
                               std::vector<std::string>& remarks) {
    return with_exr_errors(file, "no EXR could be made", [&] {
        ExrFile in(*origin.source);
        std::vector<std::string> told_when_read;
        const ExrLayer layer = layer_for(*origin.source, in, origin.request, told_when_read);
        const Image before = read_image(*origin.source, origin.request).image;
        if (before.width != image.width || before.height != image.height)
            fail(file, fmt::format("can't be written: the picture is {} x {}, but {} is {} x {}", image.width,
                                   image.height, origin.source->name.string(), before.width, before.height));
        const Change change(before, image, in.display(),
                            before.channels < 3
                                ? std::nullopt
                                : color_space_of(in.header(layer.part), origin.request.adaptation).to_rec709);
        std::optional<PartWriter> changed;
        if (change.any()) changed.emplace(in, layer, change, remarks);

        const std::vector<int> parts = parts_to_carry(in, remarks);
        std::vector<Imf::Header> headers;
        for (const int part : parts)
            headers.push_back(changed && part == layer.part ? changed->header() : in.header(part));
        Imf::StdOSStream stream;
        {
            // Its destructor writes the tables of rows.
            Imf::MultiPartOutputFile out(stream, headers.data(), static_cast<int>(headers.size()));
            for (std::size_t i = 0; i < parts.size(); ++i)
                if (changed && parts[i] == layer.part)
                    changed->write(out, static_cast<int>(i));
                else
                    copy_part(in.input(), parts[i], out, static_cast<int>(i));
        }
        return stream.str();
    });
}

} // namespace postfx::formats
