// WebP, by libwebp.
#include <image/formats.hpp>
#include <image/stored_picture.hpp>

#include <fmt/format.h>

#include <webp/decode.h>
#include <webp/demux.h>

#include <memory>

namespace postfx::formats {
namespace {

struct DeleteDemuxer {
    void operator()(WebPDemuxer* demuxer) const { WebPDemuxDelete(demuxer); }
};
using Demuxer = std::unique_ptr<WebPDemuxer, DeleteDemuxer>;

std::optional<std::string_view> chunk_of(const WebPDemuxer* demuxer, const char* name) {
    WebPChunkIterator chunk;
    if (!WebPDemuxGetChunk(demuxer, name, 1, &chunk)) return std::nullopt;
    const std::string_view data(reinterpret_cast<const char*>(chunk.chunk.bytes), chunk.chunk.size);
    WebPDemuxReleaseChunkIterator(&chunk); // it owns nothing: the bytes are the file's
    return data;
}

/// The only picture, or the first one of an animation, as a WebP of its own.
std::string_view first_picture(const Path& file, const WebPDemuxer* demuxer, int width, int height) {
    WebPIterator frame;
    if (!WebPDemuxGetFrame(demuxer, 1, &frame) || !frame.complete) fail(file, "truncated WebP");
    const std::string_view bytes(reinterpret_cast<const char*>(frame.fragment.bytes), frame.fragment.size);
    const bool whole = frame.width == width && frame.height == height;
    WebPDemuxReleaseIterator(&frame);
    if (!whole)
        fail(file, "an animated WebP whose first picture is a part of the whole; save one frame of it");
    return bytes;
}

void decode(const Path& file, std::string_view bytes, StoredPicture& picture) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(data, bytes.size(), &features) != VP8_STATUS_OK)
        fail(file, "truncated or damaged WebP");
    check_size(file, features.width, features.height);
    const int channels = features.has_alpha ? 4 : 3, row_bytes = features.width * channels;
    std::vector<std::uint8_t> codes(static_cast<std::size_t>(row_bytes)
                                    * static_cast<std::size_t>(features.height));
    const auto decoder = channels == 4 ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
    if (!decoder(data, bytes.size(), codes.data(), codes.size(), row_bytes))
        fail(file, "truncated or damaged WebP");
    picture.samples = Image(features.width, features.height, channels);
    for (int y = 0; y < features.height; ++y)
        std::copy_n(codes.data() + static_cast<std::ptrdiff_t>(y) * row_bytes, row_bytes,
                    picture.samples.pixel(0, features.height - 1 - y));
    if (channels == 4) picture.coding.alpha = Coding::Alpha::straight;
    picture.attributes.emplace_back("coding", features.format == 2 ? "lossless" : "lossy");
}

StoredPicture stored_webp(const ImageSource& source) {
    const WebPData data = {reinterpret_cast<const std::uint8_t*>(source.bytes.data()), source.bytes.size()};
    const Demuxer demuxer(WebPDemux(&data));
    if (!demuxer) fail(source.name, "truncated or damaged WebP");
    const auto width = static_cast<int>(WebPDemuxGetI(demuxer.get(), WEBP_FF_CANVAS_WIDTH));
    const auto height = static_cast<int>(WebPDemuxGetI(demuxer.get(), WEBP_FF_CANVAS_HEIGHT));
    check_size(source.name, width, height);
    StoredPicture picture;
    decode(source.name, first_picture(source.name, demuxer.get(), width, height), picture);
    const auto profile = chunk_of(demuxer.get(), "ICCP");
    if (profile) picture.color = color_of_icc(*profile, 3);
    if (picture.color.profile) picture.attributes.emplace_back("ICC profile", picture.color.profile->name());
    if (const auto exif = chunk_of(demuxer.get(), "EXIF")) take_exif(picture, *exif, profile.has_value());
    if (WebPDemuxGetI(demuxer.get(), WEBP_FF_FRAME_COUNT) > 1)
        picture.warnings.emplace_back("it is animated: the first picture was taken");
    return picture;
}

bool recognises_webp(std::string_view bytes) {
    return bytes.size() >= 12 && bytes.starts_with("RIFF") && bytes.substr(8, 4) == "WEBP";
}

ImageFile read_webp(const ImageSource& source, const ImageRequest& request) {
    expect_no_layers(source, request);
    return as_asked(stored_webp(source), request);
}

ImageDescription describe_webp(const ImageSource& source) {
    return described(webp.name, stored_webp(source));
}

} // namespace

const Format webp = {"WebP", recognises_webp, read_webp, describe_webp};

} // namespace postfx::formats
