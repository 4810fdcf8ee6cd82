// Accessors of glTF: numbers in buffers, in six types, with strides, normalised or sparse.
#include "gltf_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

namespace postfx::host {
namespace {

using Json = GltfDocument::Json;

struct Component {
    std::size_t bytes;
    double largest; ///< what 1 is, when normalised
};

Component component_of(const GltfDocument& document, std::size_t type) {
    switch (type) {
    case 5120:
        return {1, 127};
    case 5121:
        return {1, 255};
    case 5122:
        return {2, 32767};
    case 5123:
        return {2, 65535};
    case 5125:
        return {4, 4294967295.0};
    case 5126:
        return {4, 1};
    default:
        document.fail(fmt::format("componentType {} is none of glTF's", type));
    }
}

template<class T>
double value_at(const std::uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
}

double read_component(std::size_t type, const std::uint8_t* bytes) {
    switch (type) {
    case 5120:
        return value_at<std::int8_t>(bytes);
    case 5121:
        return value_at<std::uint8_t>(bytes);
    case 5122:
        return value_at<std::int16_t>(bytes);
    case 5123:
        return value_at<std::uint16_t>(bytes);
    case 5125:
        return value_at<std::uint32_t>(bytes);
    default:
        return value_at<float>(bytes);
    }
}

/// Elements that lie somewhere in a buffer view.
struct Layout {
    std::size_t type, count, width,
        columns; ///< columns: of a matrix, each of which begins at a multiple of 4 bytes
};

/// Call visit(index of the number among all, value) for every number.
template<class Visit>
void read_elements(const GltfDocument& document, const Json& where, const Layout& layout, Visit visit) {
    const std::size_t view = document.index(where, "bufferView");
    const GltfDocument::Bytes bytes = document.view_bytes(view);
    const std::size_t size = component_of(document, layout.type).bytes;
    const std::size_t rows = layout.width / layout.columns;
    const std::size_t column_bytes = layout.columns == 1 ? rows * size : (rows * size + 3) / 4 * 4;
    const std::size_t packed = column_bytes * layout.columns;
    const std::size_t stride =
        document.find_index(document.item("bufferViews", view), "byteStride").value_or(packed);
    const std::size_t offset = document.find_index(where, "byteOffset").value_or(0);
    if (layout.count == 0) return;
    const bool fits =
        stride >= packed && offset <= bytes.size() && packed <= bytes.size() - offset
        && (layout.count - 1) <= (bytes.size() - offset - packed) / std::max<std::size_t>(stride, 1);
    if (!fits) {
        document.fail(fmt::format("bufferViews[{}] has {} bytes, too few for {} elements of {} bytes each",
                                  view, bytes.size(), layout.count, packed));
    }
    for (std::size_t element = 0; element < layout.count; ++element) {
        for (std::size_t i = 0; i < layout.width; ++i) {
            const std::size_t at = offset + element * stride + i / rows * column_bytes + i % rows * size;
            visit(element * layout.width + i, read_component(layout.type, bytes.data() + at));
        }
    }
}

std::size_t columns_of(const Json& accessor) {
    const std::string type = accessor.value("type", "");
    return type.starts_with("MAT") && type.size() == 4 ? static_cast<std::size_t>(type[3] - '0') : 1;
}

/// An accessor that keeps its values nowhere is all zeros: they would cost memory that no file has.
constexpr std::size_t most_zeros = std::size_t{1} << 24u;

std::vector<double> read_accessor(const GltfDocument& document, std::size_t index, std::size_t width) {
    const Json& accessor = document.item("accessors", index);
    if (const std::size_t has = accessor_width(document, index); has != width)
        document.fail(
            fmt::format("accessors[{}] has {} numbers to an element, expected {}", index, has, width));
    const Layout layout{document.index(accessor, "componentType"), document.index(accessor, "count"), width,
                        columns_of(accessor)};
    const Component component = component_of(document, layout.type);
    const bool normalised = accessor.value("normalized", false) && layout.type != 5126;
    const auto scaled = [&](double value) {
        return normalised ? std::max(value / component.largest, -1.0) : value;
    };
    const bool has_view = accessor.contains("bufferView");
    const std::size_t view_size =
        has_view ? document.view_bytes(document.index(accessor, "bufferView")).size() : most_zeros;
    if (layout.count > view_size)
        document.fail(fmt::format("accessors[{}] has no bytes for {} elements", index, layout.count));
    std::vector<double> values(layout.count * width, 0.0);
    if (has_view) {
        read_elements(document, accessor, layout,
                      [&](std::size_t i, double value) { values[i] = scaled(value); });
    }
    if (const auto sparse = accessor.find("sparse"); sparse != accessor.end()) {
        const std::size_t count = document.index(*sparse, "count");
        if (count > layout.count)
            document.fail(fmt::format("accessors[{}] has more sparse values than values", index));
        const Json& places = sparse->at("indices");
        std::vector<std::size_t> targets(count);
        read_elements(document, places, {document.index(places, "componentType"), count, 1, 1},
                      [&](std::size_t i, double value) { targets[i] = static_cast<std::size_t>(value); });
        read_elements(document, sparse->at("values"), {layout.type, count, width, layout.columns},
                      [&](std::size_t i, double value) {
                          const std::size_t element = targets[i / width];
                          if (element >= layout.count)
                              document.fail(fmt::format("accessors[{}] has a sparse value for element {}",
                                                        index, element));
                          values[element * width + i % width] = scaled(value);
                      });
    }
    return values;
}

} // namespace

std::size_t accessor_width(const GltfDocument& document, std::size_t accessor) {
    constexpr std::array<std::pair<std::string_view, std::size_t>, 7> widths{
        {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
    const std::string type = document.item("accessors", accessor).value("type", "");
    for (const auto& [name, width] : widths) {
        if (name == type) return width;
    }
    document.fail(fmt::format("accessors[{}] has the type \"{}\", which is none of glTF's", accessor, type));
}

std::vector<float> read_numbers(const GltfDocument& document, std::size_t accessor, std::size_t width) {
    const std::vector<double> values = read_accessor(document, accessor, width);
    std::vector<float> result(values.size());
    std::transform(values.begin(), values.end(), result.begin(),
                   [](double value) { return static_cast<float>(value); });
    return result;
}

std::vector<std::uint32_t> read_integers(const GltfDocument& document, std::size_t accessor,
                                         std::size_t width) {
    if (document.index(document.item("accessors", accessor), "componentType") == 5126)
        document.fail(fmt::format("accessors[{}] has fractions, expected whole numbers", accessor));
    const std::vector<double> values = read_accessor(document, accessor, width);
    std::vector<std::uint32_t> result(values.size());
    std::transform(values.begin(), values.end(), result.begin(),
                   [](double value) { return static_cast<std::uint32_t>(std::max(value, 0.0)); });
    return result;
}

} // namespace postfx::host
