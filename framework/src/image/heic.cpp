// HEIC photographs of phones, by libheif: colour, and the depth or disparity image beside it.
#include <image/formats.hpp>
#include <image/stored_picture.hpp>

#include <fmt/format.h>

#include <libheif/heif.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

namespace postfx::formats {
namespace {

template<auto release>
struct Release {
    template<class Thing>
    void operator()(Thing* thing) const {
        release(thing);
    }
};
using Context = std::unique_ptr<heif_context, Release<heif_context_free>>;
using Handle = std::unique_ptr<heif_image_handle, Release<heif_image_handle_release>>;
using Picture = std::unique_ptr<heif_image, Release<heif_image_release>>;
using Nclx = std::unique_ptr<heif_color_profile_nclx, Release<heif_nclx_color_profile_free>>;

void check(const Path& file, const heif_error& error) {
    if (error.code != heif_error_Ok) fail(file, fmt::format("truncated or damaged HEIC ({})", error.message));
}

/// The file and its main picture.
struct Opened {
    Context context;
    Handle primary;
};

Opened opened(const ImageSource& source) {
    Opened file{Context(heif_context_alloc()), nullptr};
    if (!file.context) throw std::bad_alloc();
    heif_context_set_maximum_image_size_limit(file.context.get(), static_cast<int>(max_side));
    check(source.name, heif_context_read_from_memory_without_copy(file.context.get(), source.bytes.data(),
                                                                  source.bytes.size(), nullptr));
    heif_image_handle* handle = nullptr;
    check(source.name, heif_context_get_primary_image_handle(file.context.get(), &handle));
    file.primary.reset(handle);
    return file;
}

void check_handle(const Path& file, const heif_image_handle* handle) {
    check_size(file, heif_image_handle_get_width(handle), heif_image_handle_get_height(handle));
    // Before any rotation and cutting: what is decoded.
    check_size(file, heif_image_handle_get_ispe_width(handle), heif_image_handle_get_ispe_height(handle));
}

Picture decoded(const Path& file, const heif_image_handle* handle, heif_colorspace space,
                heif_chroma chroma) {
    check_handle(file, handle);
    heif_image* image = nullptr;
    check(file, heif_decode_image(handle, &image, space, chroma, nullptr));
    return Picture(image);
}

/// Rows of a plane, which holds all `channels` of a pixel together; top row first. Samples of more than 8 bits have two
/// bytes, the less significant one first.
void copy_plane(const Path& file, const heif_image* image, heif_channel plane, int channels,
                StoredPicture& picture) {
    int stride = 0;
    const std::uint8_t* bytes = heif_image_get_plane_readonly(image, plane, &stride);
    const int width = heif_image_get_width(image, plane), height = heif_image_get_height(image, plane);
    const int bits = heif_image_get_bits_per_pixel_range(image, plane);
    if (!bytes || bits < 1 || bits > 16) fail(file, "damaged HEIC: its decoded picture has no samples");
    check_size(file, width, height);
    picture.samples = Image(width, height, channels);
    picture.coding.bits = bits;
    picture.largest = std::ldexp(1.0, bits) - 1;
    for (int y = 0; y < height; ++y) {
        const std::uint8_t* row = bytes + static_cast<std::ptrdiff_t>(y) * stride;
        float* to = picture.samples.pixel(0, height - 1 - y);
        for (int i = 0; i < width * channels; ++i)
            to[i] = static_cast<float>(bits == 8 ? row[i] : row[2 * i] | row[2 * i + 1] << 8);
    }
}

std::optional<std::string> icc_profile_of(const Path& file, const heif_image_handle* handle) {
    const auto type = heif_image_handle_get_color_profile_type(handle);
    if (type != heif_color_profile_type_rICC && type != heif_color_profile_type_prof) return std::nullopt;
    std::string profile(heif_image_handle_get_raw_color_profile_size(handle), '\0');
    check(file, heif_image_handle_get_raw_color_profile(handle, profile.data()));
    return profile;
}

/// libheif has made full-range RGB of whatever range and matrix the file's nclx states.
ColorStatement color_of(const Path& file, const heif_image_handle* handle, StoredPicture& picture) {
    if (const std::optional<std::string> profile = icc_profile_of(file, handle)) {
        ColorStatement statement = color_of_icc(*profile, 3);
        if (statement.profile) picture.attributes.emplace_back("ICC profile", statement.profile->name());
        return statement;
    }
    heif_color_profile_nclx* found = nullptr;
    constexpr int unspecified = 2;
    if (heif_image_handle_get_nclx_color_profile(handle, &found).code != heif_error_Ok || !found) return {};
    const Nclx nclx(found);
    const int primaries = nclx->color_primaries, transfer = nclx->transfer_characteristics;
    picture.attributes.emplace_back("nclx", fmt::format("primaries {}, transfer {}", primaries, transfer));
    if (primaries == unspecified && transfer == unspecified) return {};
    return color_of_cicp("HEIC nclx", primaries == unspecified ? 1 : primaries,
                         transfer == unspecified ? 13 : transfer, true, picture.coding.bits);
}

std::optional<std::string> exif_of(const heif_image_handle* handle) {
    heif_item_id id = 0;
    if (heif_image_handle_get_list_of_metadata_block_IDs(handle, "Exif", &id, 1) != 1) return std::nullopt;
    std::string bytes(heif_image_handle_get_metadata_size(handle, id), '\0');
    if (bytes.size() < 4 || heif_image_handle_get_metadata(handle, id, bytes.data()).code != heif_error_Ok)
        return std::nullopt;
    std::size_t offset = 0; // of the TIFF behind this number
    for (std::size_t i = 0; i < 4; ++i)
        offset = offset << 8 | static_cast<std::uint8_t>(bytes[i]);
    return bytes.substr(std::min(bytes.size(), 4 + offset));
}

/// Auxiliary pictures other than alpha and depth are told of: a gain map would brighten highlights.
void note_auxiliaries(const heif_image_handle* handle, StoredPicture& picture) {
    const int filter = LIBHEIF_AUX_IMAGE_FILTER_OMIT_ALPHA | LIBHEIF_AUX_IMAGE_FILTER_OMIT_DEPTH;
    std::vector<heif_item_id> ids(static_cast<std::size_t>(
        std::max(0, heif_image_handle_get_number_of_auxiliary_images(handle, filter))));
    heif_image_handle_get_list_of_auxiliary_image_IDs(handle, filter, ids.data(),
                                                      static_cast<int>(ids.size()));
    for (const heif_item_id id : ids) {
        heif_image_handle* found = nullptr;
        if (heif_image_handle_get_auxiliary_image_handle(handle, id, &found).code != heif_error_Ok) continue;
        const Handle auxiliary(found);
        const char* type = nullptr;
        if (heif_image_handle_get_auxiliary_type(found, &type).code != heif_error_Ok || !type) continue;
        picture.attributes.emplace_back("auxiliary picture", type);
        if (std::string_view(type).find("gainmap") != std::string_view::npos)
            picture.warnings.emplace_back("its HDR gain map is left out: the picture is what it is without");
        heif_image_handle_free_auxiliary_types(found, &type);
    }
}

StoredPicture stored_color(const Path& file, const heif_image_handle* handle) {
    StoredPicture picture;
    const bool alpha = heif_image_handle_has_alpha_channel(handle) != 0;
    const bool deep = heif_image_handle_get_luma_bits_per_pixel(handle) > 8;
    const heif_chroma chroma =
        deep    ? alpha ? heif_chroma_interleaved_RRGGBBAA_LE : heif_chroma_interleaved_RRGGBB_LE
        : alpha ? heif_chroma_interleaved_RGBA
                : heif_chroma_interleaved_RGB;
    const Picture image = decoded(file, handle, heif_colorspace_RGB, chroma);
    copy_plane(file, image.get(), heif_channel_interleaved, alpha ? 4 : 3, picture);
    if (alpha)
        picture.coding.alpha = heif_image_handle_is_premultiplied_alpha(handle) ? Coding::Alpha::premultiplied
                                                                                : Coding::Alpha::straight;
    picture.color = color_of(file, handle, picture);
    if (const std::optional<std::string> exif = exif_of(handle)) take_exif(picture, *exif, true);
    picture.orientation = 1; // libheif has turned it, by the file's own properties; EXIF repeats them
    note_auxiliaries(handle, picture);
    return picture;
}

Handle depth_handle(const Path& file, const heif_image_handle* primary, heif_item_id& id) {
    if (heif_image_handle_get_list_of_depth_image_IDs(primary, &id, 1) != 1)
        fail(file, "this HEIC holds no depth image (portrait photographs do)");
    heif_image_handle* handle = nullptr;
    check(file, heif_image_handle_get_depth_image_handle(primary, id, &handle));
    return Handle(handle);
}

/// The depth representation information of ITU-T H.265 (annex G), which HEIC repeats: what the smallest and the
/// largest sample stand for. Phones state disparity in dioptres.
std::optional<DepthScale> scale_of(const heif_depth_representation_info& info) {
    const bool z = info.has_z_near && info.has_z_far && info.z_near > 0 && info.z_far > 0;
    const bool d = info.has_d_min && info.has_d_max;
    switch (info.depth_representation_type) {
    case heif_depth_representation_type_uniform_inverse_Z:
        if (z) return DepthScale{DepthScale::Kind::dioptres, 1 / info.z_far, 1 / info.z_near};
        break;
    case heif_depth_representation_type_uniform_disparity:
        if (d) return DepthScale{DepthScale::Kind::dioptres, info.d_min, info.d_max};
        break;
    case heif_depth_representation_type_uniform_Z:
        if (z) return DepthScale{DepthScale::Kind::metres, info.z_near, info.z_far};
        break;
    case heif_depth_representation_type_nonuniform_disparity:
        break;
    }
    return std::nullopt;
}

ImageFile read_depth(const Path& file, const heif_image_handle* primary) {
    heif_item_id id = 0;
    const Handle handle = depth_handle(file, primary, id);
    StoredPicture picture;
    const Picture image = decoded(file, handle.get(), heif_colorspace_monochrome, heif_chroma_monochrome);
    copy_plane(file, image.get(), heif_channel_Y, 1, picture);
    ImageFile depth = as_asked(std::move(picture), {.role = Role::depth});
    depth.layer = "depth image";

    const heif_depth_representation_info* info = nullptr;
    if (heif_image_handle_get_depth_image_representation_info(primary, id, &info) && info) {
        depth.depth_scale = scale_of(*info);
        heif_depth_representation_info_free(info);
    }
    if (!depth.depth_scale)
        depth.warnings.emplace_back("its depth image does not say what its samples stand for");
    return depth;
}

bool recognises_heic(std::string_view bytes) {
    if (bytes.size() < 12 || bytes.substr(4, 4) != "ftyp") return false;
    static constexpr std::string_view brands[] = {"heic", "heix", "heim", "heis", "hevc",
                                                  "hevx", "mif1", "msf1", "avif"};
    return std::find(std::begin(brands), std::end(brands), bytes.substr(8, 4)) != std::end(brands);
}

ImageFile read_heic(const ImageSource& source, const ImageRequest& request) {
    expect_no_layers(source, request);
    const Opened file = opened(source);
    if (request.role == Role::depth) return read_depth(source.name, file.primary.get());
    ImageFile color = as_asked(stored_color(source.name, file.primary.get()), request);
    color.has_depth_map = heif_image_handle_has_depth_image(file.primary.get()) != 0;
    return color;
}

ImageDescription describe_heic(const ImageSource& source) {
    const Opened file = opened(source);
    ImageDescription description = described(heic.name, stored_color(source.name, file.primary.get()));
    for (RoleDescription& role : description.roles) {
        if (role.role != Role::depth) continue;
        if (heif_image_handle_has_depth_image(file.primary.get()))
            role.layer = "depth image";
        else
            role.refusal = "there is no depth image in the file";
    }
    return description;
}

} // namespace

const Format heic = {"HEIC", recognises_heic, read_heic, describe_heic};

} // namespace postfx::formats
