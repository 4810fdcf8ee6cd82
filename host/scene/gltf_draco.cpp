// KHR_draco_mesh_compression, decoded by Google's library.
#include "gltf_reader.hpp"

#include <fmt/format.h>

#include <draco/compression/decode.h>

namespace postfx::host {
namespace {

DracoMesh::Attribute values_of(const draco::PointAttribute& attribute, std::uint32_t points) {
    DracoMesh::Attribute result;
    result.width = static_cast<std::size_t>(attribute.num_components());
    result.values.resize(result.width * points);
    for (std::uint32_t point = 0; point < points; ++point) {
        attribute.ConvertValue<float>(attribute.mapped_index(draco::PointIndex(point)),
                                      &result.values[result.width * point]);
    }
    return result;
}

} // namespace

DracoMesh read_draco(const GltfDocument& document, const GltfDocument::Json& extension) {
    const GltfDocument::Bytes bytes = document.view_bytes(document.index(extension, "bufferView"));
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        document.fail(fmt::format("can't decompress a mesh (Draco): {}", decoded.status().error_msg()));
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();

    DracoMesh result;
    for (const auto& [name, id] : extension.at("attributes").items()) {
        if (!id.is_number_unsigned()) document.fail("a Draco attribute's number is no number");
        const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(id.get<std::uint32_t>());
        if (!attribute) document.fail(fmt::format("the Draco mesh has no attribute for {}", name));
        result.attributes[name] = values_of(*attribute, mesh->num_points());
    }
    for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face) {
        for (const draco::PointIndex& point : mesh->face(face))
            result.indices.push_back(point.value());
    }
    return result;
}

} // namespace postfx::host
