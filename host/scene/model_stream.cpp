#include "model_stream.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>
#include <type_traits>

namespace postfx::host {
namespace {

enum class Tag : std::uint8_t { picture = 1, model, error, out_of_memory };

[[noreturn]] void fail() {
    throw std::runtime_error("this is no model");
}

void require(bool holds) {
    if (!holds) fail();
}

class Output {
public:
    static constexpr bool reads = false;

    Output(const ModelWriter::Sink& sink, const std::map<PicturePtr, std::uint32_t>& pictures)
        : sink_(sink), pictures_(pictures) {}

    void bytes(void* data, std::size_t size) { sink_(data, size); }

    void picture(PicturePtr& picture) {
        std::uint32_t number = picture ? pictures_.at(picture) + 1 : 0;
        bytes(&number, sizeof number);
    }
    /// The index of something that is shared, and whether it follows.
    template<class T>
    bool shared(const std::shared_ptr<const T>& value, std::uint32_t& index) {
        const auto [known, added] =
            shared_.try_emplace(value.get(), static_cast<std::uint32_t>(shared_.size()));
        index = known->second;
        bytes(&index, sizeof index);
        return added;
    }

private:
    const ModelWriter::Sink& sink_;
    const std::map<PicturePtr, std::uint32_t>& pictures_;
    std::map<const void*, std::uint32_t> shared_;
};

class Input {
public:
    static constexpr bool reads = true;

    Input(const std::function<void(void*, std::size_t)>& source, std::size_t limit)
        : source_(source), left_(limit) {}

    void bytes(void* data, std::size_t size) {
        if (size > left_) throw std::bad_alloc();
        left_ -= size;
        source_(data, size);
    }
    void picture(PicturePtr& picture) {
        std::uint32_t number = 0;
        bytes(&number, sizeof number);
        require(number <= pictures.size());
        picture = number == 0 ? nullptr : pictures[number - 1];
    }

    std::vector<PicturePtr> pictures;
    std::vector<std::shared_ptr<const Mesh>> meshes;

private:
    const std::function<void(void*, std::size_t)>& source_;
    std::size_t left_;
};

/// What is written and read as it lies in memory.
template<class T>
concept Plain =
    std::is_arithmetic_v<T> || std::is_same_v<T, glm::vec2> || std::is_same_v<T, glm::vec3> || std::is_same_v<
        T, glm::dvec3> || std::is_same_v<T, glm::dquat> || std::is_same_v<T, glm::dmat4> || std::
        is_same_v<T, glm::mat3x2> || std::is_same_v<T, Vertex> || std::is_same_v<T, VertexExtra>;

// One description of every type serves both ways: exchange(archive, value) writes the value or reads it.

template<class A, Plain T>
void exchange(A& archive, T& value) {
    archive.bytes(&value, sizeof value);
}

template<class A>
void exchange(A& archive, bool& value) {
    std::uint8_t byte = value ? 1 : 0;
    archive.bytes(&byte, 1);
    value = byte != 0;
}

template<class A, class E>
void exchange_choice(A& archive, E& value, E last) {
    auto byte = static_cast<std::uint8_t>(value);
    archive.bytes(&byte, 1);
    require(byte <= static_cast<std::uint8_t>(last));
    value = static_cast<E>(byte);
}

/// Room is made as the bytes arrive: a count that lies costs nothing.
template<class A, class T>
void exchange_plain_list(A& archive, T& values) {
    using Element = typename T::value_type;
    auto count = static_cast<std::uint64_t>(values.size());
    archive.bytes(&count, sizeof count);
    if constexpr (A::reads) {
        constexpr std::uint64_t step = (std::uint64_t{1} << 20u) / sizeof(Element);
        values.clear();
        for (std::uint64_t at = 0; at < count; at += step) {
            const auto more = static_cast<std::size_t>(std::min(step, count - at));
            values.resize(static_cast<std::size_t>(at) + more);
            archive.bytes(values.data() + at, more * sizeof(Element));
        }
    } else if (count > 0) {
        archive.bytes(values.data(), values.size() * sizeof(Element));
    }
}

template<class A>
void exchange(A& archive, std::string& text) {
    exchange_plain_list(archive, text);
}

template<class A, class T>
void exchange(A& archive, std::vector<T>& values) {
    if constexpr (Plain<T>) {
        exchange_plain_list(archive, values);
    } else {
        auto count = static_cast<std::uint64_t>(values.size());
        archive.bytes(&count, sizeof count);
        if constexpr (A::reads) values.clear();
        for (std::uint64_t i = 0; i < count; ++i) {
            if constexpr (A::reads) values.emplace_back();
            exchange(archive, values[static_cast<std::size_t>(i)]);
        }
    }
}

template<class A, class T>
void exchange(A& archive, std::optional<T>& value) {
    bool there = value.has_value();
    exchange(archive, there);
    if constexpr (A::reads) value = there ? std::optional<T>(T()) : std::nullopt;
    if (there) exchange(archive, *value);
}

template<class A>
void exchange(A& archive, Texture& texture) {
    archive.picture(texture.picture);
    exchange_choice(archive, texture.sampler.wrap_u, Sampler::Wrap::mirror);
    exchange_choice(archive, texture.sampler.wrap_v, Sampler::Wrap::mirror);
    exchange_choice(archive, texture.sampler.magnify, Sampler::Filter::linear);
    exchange_choice(archive, texture.sampler.minify, Sampler::Filter::linear);
    exchange_choice(archive, texture.sampler.mips, Sampler::Mips::linear);
    exchange(archive, texture.uv_set);
    exchange(archive, texture.placement);
}

template<class A>
void exchange(A& archive, Material& m) {
    exchange(archive, m.name);
    for (glm::vec3* color : {&m.diffuse, &m.specular, &m.emission})
        exchange(archive, *color);
    for (float* number : {&m.shininess, &m.opacity, &m.alpha_cutoff, &m.metalness, &m.roughness,
                          &m.normal_scale, &m.occlusion_strength})
        exchange(archive, *number);
    for (bool* flag : {&m.two_sided, &m.blended, &m.unlit, &m.metal_rough})
        exchange(archive, *flag);
    for (Texture* texture : {&m.diffuse_texture, &m.emission_texture, &m.normal_texture,
                             &m.metal_roughness_texture, &m.occlusion_texture})
        exchange(archive, *texture);
}

template<class A>
void exchange(A& archive, Deformation::Shape& shape) {
    exchange(archive, shape.positions);
    exchange(archive, shape.normals);
}

template<class A>
void exchange(A& archive, Deformation& deformation) {
    exchange(archive, deformation.shapes);
    exchange(archive, deformation.influences);
    exchange(archive, deformation.joints);
    exchange(archive, deformation.weights);
}

template<class A>
void exchange(A& archive, Mesh& mesh) {
    exchange(archive, mesh.vertices);
    exchange(archive, mesh.indices);
    exchange(archive, mesh.extras);
    bool deforms = mesh.deformation != nullptr;
    exchange(archive, deforms);
    if (!deforms) return;
    Deformation deformation = mesh.deformation ? *mesh.deformation : Deformation();
    exchange(archive, deformation);
    if constexpr (A::reads) mesh.deformation = std::make_shared<const Deformation>(std::move(deformation));
}

template<class A>
void exchange(A& archive, std::shared_ptr<const Mesh>& mesh) {
    std::uint32_t index = 0;
    if constexpr (A::reads) {
        archive.bytes(&index, sizeof index);
        require(index <= archive.meshes.size());
        if (index == archive.meshes.size()) {
            auto read = std::make_shared<Mesh>();
            exchange(archive, *read);
            archive.meshes.push_back(std::move(read));
        }
        mesh = archive.meshes[index];
    } else if (archive.shared(mesh, index)) {
        Mesh copy = *mesh;
        exchange(archive, copy);
    }
}

template<class A>
void exchange(A& archive, Part& part) {
    exchange(archive, part.mesh);
    exchange(archive, part.material);
}

template<class A>
void exchange(A& archive, Track& track) {
    exchange_choice(archive, track.interpolation, Track::Interpolation::cubic);
    exchange(archive, track.width);
    exchange(archive, track.times);
    exchange(archive, track.values);
}

template<class A>
void exchange(A& archive, NodeKeys& keys) {
    exchange(archive, keys.translation);
    exchange(archive, keys.rotation);
    exchange(archive, keys.scale);
    for (std::optional<Track>* track :
         {&keys.translations, &keys.rotations, &keys.scales, &keys.shape_weights})
        exchange(archive, *track);
    exchange(archive, keys.duration);
}

template<class A>
void exchange(A& archive, Node& node) {
    exchange(archive, node.name);
    exchange(archive, node.parent);
    exchange(archive, node.local);
    std::optional<NodeKeys> keys;
    if (node.keys) keys = *node.keys;
    exchange(archive, keys);
    if constexpr (A::reads) node.keys = keys ? std::make_shared<const NodeKeys>(std::move(*keys)) : nullptr;
    exchange(archive, node.parts);
    exchange(archive, node.skin);
    exchange(archive, node.shape_weights);
}

template<class A>
void exchange(A& archive, Skin& skin) {
    exchange(archive, skin.joints);
    exchange(archive, skin.mesh_to_joint);
}

template<class A>
void exchange(A& archive, Light& light) {
    exchange_choice(archive, light.kind, Light::Kind::spot);
    exchange(archive, light.node);
    exchange(archive, light.color);
    exchange(archive, light.attenuation);
    for (float* number : {&light.range, &light.inner_angle, &light.outer_angle})
        exchange(archive, *number);
}

template<class A>
void exchange(A& archive, NamedCamera& named) {
    SceneCamera& camera = named.camera;
    exchange(archive, named.names);
    exchange(archive, camera.parent);
    for (glm::dvec3* vector : {&camera.position, &camera.look_at, &camera.up})
        exchange(archive, *vector);
    for (double* number : {&camera.vertical_fov, &camera.near_plane, &camera.far_plane})
        exchange(archive, *number);
    exchange(archive, camera.orthographic_extent);
}

template<class A>
void exchange(A& archive, Model& model) {
    exchange(archive, model.materials);
    exchange(archive, model.nodes);
    exchange(archive, model.skins);
    exchange(archive, model.lights);
    exchange(archive, model.cameras);
    exchange(archive, model.losses);
}

template<class A>
void exchange(A& archive, Picture& picture) {
    exchange(archive, picture.width);
    exchange(archive, picture.height);
    exchange(archive, picture.srgb);
    exchange(archive, picture.rgba);
}

void check(const Track& track, std::size_t width) {
    const std::size_t per_key = track.interpolation == Track::Interpolation::cubic ? 3 : 1;
    require(track.width == width && !track.times.empty()
            && track.values.size() == per_key * width * track.times.size());
}

void check(const Mesh& mesh) {
    const std::size_t count = mesh.vertices.size();
    require(
        std::all_of(mesh.indices.begin(), mesh.indices.end(), [&](std::uint32_t i) { return i < count; }));
    require(mesh.extras.empty() || mesh.extras.size() == count);
    if (!mesh.deformation) return;
    const Deformation& deformation = *mesh.deformation;
    for (const Deformation::Shape& shape : deformation.shapes)
        require(shape.positions.size() == count && (shape.normals.empty() || shape.normals.size() == count));
    require(deformation.influences <= deformation.joints.size());
    require(deformation.joints.size() == deformation.influences * count
            && deformation.weights.size() == deformation.joints.size());
}

void check(const Model& model) {
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const Node& node = model.nodes[i];
        require(!node.parent || *node.parent < i);
        require(!node.skin || *node.skin < model.skins.size());
        if (node.keys) {
            const NodeKeys& keys = *node.keys;
            if (keys.translations) check(*keys.translations, 3);
            if (keys.rotations) check(*keys.rotations, 4);
            if (keys.scales) check(*keys.scales, 3);
            if (keys.shape_weights) check(*keys.shape_weights, node.shape_weights.size());
        }
        for (const Part& part : node.parts) {
            require(part.material < model.materials.size());
            if (!part.mesh->deformation || !node.skin) continue;
            const auto& joints = part.mesh->deformation->joints;
            const std::size_t count = model.skins[*node.skin].joints.size();
            require(std::all_of(joints.begin(), joints.end(),
                                [&](std::uint32_t joint) { return joint < count; }));
        }
    }
    for (const Skin& skin : model.skins) {
        require(skin.mesh_to_joint.size() == skin.joints.size());
        for (const std::size_t joint : skin.joints)
            require(joint < model.nodes.size());
    }
    for (const Material& material : model.materials) {
        for (const Texture* texture :
             {&material.diffuse_texture, &material.emission_texture, &material.normal_texture,
              &material.metal_roughness_texture, &material.occlusion_texture})
            require(texture->uv_set < 2);
    }
    for (const Light& light : model.lights)
        require(light.node < model.nodes.size());
    for (const NamedCamera& camera : model.cameras)
        require(!camera.names.empty()
                && (!camera.camera.parent || *camera.camera.parent < model.nodes.size()));
}

template<class A>
void exchange_error(A& archive, Place& place, std::string& message) {
    for (std::string* text : {&place.file, &place.effect, &place.pass, &message})
        exchange(archive, *text);
    exchange(archive, place.line);
    exchange(archive, place.column);
}

Tag read_tag(Input& input) {
    Tag tag{};
    exchange_choice(input, tag, Tag::out_of_memory);
    return tag;
}

PicturePtr read_picture(Input& input) {
    auto picture = std::make_shared<Picture>();
    exchange(input, *picture);
    require(picture->width > 0 && picture->height > 0
            && picture->rgba.size()
                   == 4 * static_cast<std::size_t>(picture->width)
                          * static_cast<std::size_t>(picture->height));
    return picture;
}

} // namespace

PicturePtr ModelWriter::picture(const PicturePtr& picture) {
    Output output(sink_, pictures_);
    Tag tag = Tag::picture;
    exchange_choice(output, tag, Tag::out_of_memory);
    exchange(output, const_cast<Picture&>(*picture)); // only read
    auto stub = std::make_shared<const Picture>(Picture{picture->width, picture->height, {}, picture->srgb});
    pictures_.emplace(stub, static_cast<std::uint32_t>(pictures_.size()));
    return stub;
}

void ModelWriter::model(const Model& model) {
    Output output(sink_, pictures_);
    Tag tag = Tag::model;
    exchange_choice(output, tag, Tag::out_of_memory);
    Model copy = model; // shares meshes and pictures
    exchange(output, copy);
}

void ModelWriter::error(const Error& error) {
    Output output(sink_, pictures_);
    Tag tag = Tag::error;
    exchange_choice(output, tag, Tag::out_of_memory);
    Place place = error.place();
    std::string message = error.message();
    exchange_error(output, place, message);
}

void ModelWriter::out_of_memory() {
    Output output(sink_, pictures_);
    Tag tag = Tag::out_of_memory;
    exchange_choice(output, tag, Tag::out_of_memory);
}

Model read_model_stream(const std::function<void(void*, std::size_t)>& source, std::size_t limit) {
    Input input(source, limit);
    for (;;) {
        switch (read_tag(input)) {
        case Tag::picture:
            input.pictures.push_back(read_picture(input));
            break;
        case Tag::model: {
            Model model;
            exchange(input, model);
            for (const auto& mesh : input.meshes)
                check(*mesh);
            check(model);
            return model;
        }
        case Tag::error: {
            Place place;
            std::string message;
            exchange_error(input, place, message);
            throw Error(place, message);
        }
        case Tag::out_of_memory:
            throw std::bad_alloc();
        default:
            fail();
        }
    }
}

} // namespace postfx::host
