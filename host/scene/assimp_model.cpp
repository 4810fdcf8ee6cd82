#include "assimp_model.hpp"

#include "animation_clips.hpp"
#include "asset_files.hpp"
#include "assimp_parts.hpp"
#include "file_kind.hpp"
#include "mesh_checks.hpp"

#include <base/read_file.hpp>

#include <postfx/error.hpp>

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <set>

namespace postfx::host {
namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// The ending that files of the model's kind usually have, by its content; its own where the content tells nothing.
std::string usual_ending(const std::filesystem::path& file) {
    std::error_code unknown;
    const std::string ending = model_ending(read_start(file, recognized_bytes, "a model"),
                                            std::filesystem::file_size(file, unknown));
    return ending.empty() ? lower(file.extension().string()) : ending;
}

/// What is read of an OBJ and its libraries on their way to assimp.
struct ObjParts {
    std::vector<std::string> libraries;
    MtlPlacements placements;
};

/// A stream over text of its own.
class TextStream : public Assimp::MemoryIOStream {
public:
    explicit TextStream(std::shared_ptr<const std::string> text)
        : MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text->data()), text->size()),
          text_(std::move(text)) {}

private:
    std::shared_ptr<const std::string> text_;
};

/// The model under the name that its content should have, since assimp goes by names, and what it refers to as find_asset
/// finds it, OBJ and MTL as plain text; tells of every file once.
class AssetSystem : public Assimp::DefaultIOSystem {
public:
    AssetSystem(std::filesystem::path model, std::string alias, const ReadingHooks& hooks, ObjParts& parts)
        : model_(std::move(model)), alias_(std::move(alias)), hooks_(hooks), parts_(parts),
          is_obj_(alias_.ends_with(".obj")) {}

    bool Exists(const char* name) const override { return name == alias_ || DefaultIOSystem::Exists(name); }
    Assimp::IOStream* Open(const char* name, const char* mode) override {
        std::filesystem::path file = name == alias_ ? model_ : std::filesystem::path(name);
        std::error_code problem;
        if (!std::filesystem::is_regular_file(file, problem)) {
            const auto asset = find_asset(model_, name);
            if (!asset) return nullptr;
            file = *asset;
        }
        if (opened_.insert(file).second) hooks_.opening(std::filesystem::file_size(file, problem));
        if (is_obj_) return new TextStream(plain_text(file)); // assimp deletes it
        return DefaultIOSystem::Open(file.c_str(), mode);
    }

private:
    /// Of the model, or of a library.
    std::shared_ptr<const std::string> plain_text(const std::filesystem::path& file) {
        const auto [known, added] = texts_.try_emplace(file);
        if (!added) return known->second;
        const std::vector<std::uint8_t> bytes = read_asset(file);
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        std::string plain;
        if (file == model_) {
            ObjText obj = plain_obj(
                text, [&](const std::string& name) { return find_asset(model_, name).has_value(); });
            parts_.libraries = std::move(obj.libraries);
            plain = std::move(obj.text);
        } else {
            plain = plain_mtl(text, parts_.placements);
        }
        return known->second = std::make_shared<const std::string>(std::move(plain));
    }

    std::filesystem::path model_;
    std::string alias_;
    const ReadingHooks& hooks_;
    ObjParts& parts_;
    bool is_obj_;
    std::set<std::filesystem::path>
        opened_; ///< assimp opens the same file again and again, to guess what it is
    std::map<std::filesystem::path, std::shared_ptr<const std::string>> texts_;
};

class AssimpReader {
public:
    AssimpReader(const std::filesystem::path& file, const aiScene& scene, const ReadingHooks& hooks,
                 const ObjParts& parts)
        : scene_(scene), parts_(parts), pictures_(file, hooks, losses_) {
        // assimp says nothing of a library that is not there.
        static const LossKind kind{"material library is missing", "material libraries are missing"};
        for (const std::string& name : parts.libraries) {
            if (!find_asset(file, name)) losses_.add(kind, name);
        }
    }

    Model read() {
        for (unsigned i = 0; i < scene_.mNumMaterials; ++i) {
            AssimpMaterial material =
                read_assimp_material(scene_, *scene_.mMaterials[i], parts_.placements, pictures_, losses_);
            model_.materials.push_back(std::move(material.material));
            uv_sets_.push_back(material.uv_sets);
        }
        add_nodes();
        add_cameras();
        static const LossKind lights{"light is left out, for its format has no unit for it",
                                     "lights are left out, for their format has no unit for them"};
        losses_.add(lights, scene_.mNumLights ? scene_.mLights[0]->mName.C_Str() : "", scene_.mNumLights);
        std::vector<NodeKeys> at_rest;
        for (const Node& node : model_.nodes)
            at_rest.push_back(keys_at_rest(node.local));
        std::vector<AnimationClip> clips;
        for (unsigned i = 0; i < scene_.mNumAnimations; ++i)
            clips.push_back(read_assimp_animation(*scene_.mAnimations[i], node_by_name_, model_.nodes));
        play_clips(std::move(clips), at_rest, model_.nodes, losses_);
        model_.losses = losses_.lines();
        return std::move(model_);
    }

private:
    /// Parents first, then what stands in the nodes: bones may come later than what they move.
    void add_nodes() {
        std::vector<std::pair<const aiNode*, std::optional<std::size_t>>> open{
            {scene_.mRootNode, std::nullopt}};
        std::vector<const aiNode*> sources;
        for (std::size_t i = 0; i < open.size(); ++i) {
            const auto [source, parent] = open[i];
            Node node;
            node.name = source->mName.C_Str();
            node.parent = parent;
            node.local = to_glm(source->mTransformation);
            node_by_name_.try_emplace(node.name, i);
            model_.nodes.push_back(std::move(node));
            sources.push_back(source);
            for (unsigned child = 0; child < source->mNumChildren; ++child)
                open.emplace_back(source->mChildren[child], i);
        }
        for (std::size_t i = 0; i < sources.size(); ++i) {
            for (unsigned mesh = 0; mesh < sources[i]->mNumMeshes; ++mesh)
                add_part(i, sources[i]->mMeshes[mesh]);
        }
    }

    void add_part(std::size_t node, unsigned mesh) {
        const aiMesh& source = *scene_.mMeshes[mesh];
        const auto [known, added] = meshes_.try_emplace(mesh);
        if (added) {
            known->second = std::make_shared<const Mesh>(
                read_assimp_mesh(source, uv_sets_[source.mMaterialIndex], losses_));
        }
        if (known->second->empty()) return; // points and lines
        const Part part{known->second, source.mMaterialIndex};
        if (!part.mesh->deformation) {
            model_.nodes[node].parts.push_back(part);
            return;
        }
        // A node of its own, since each mesh has its own list of bones and shapes.
        Node own;
        own.name = model_.nodes[node].name;
        own.parent = node;
        own.parts.push_back(part);
        for (unsigned i = 0; i < source.mNumAnimMeshes; ++i)
            own.shape_weights.push_back(source.mAnimMeshes[i]->mWeight);
        if (source.mNumBones > 0) {
            own.skin = model_.skins.size();
            model_.skins.push_back(read_skin(source, node));
        }
        model_.nodes.push_back(std::move(own));
    }

    Skin read_skin(const aiMesh& mesh, std::size_t otherwise) {
        static const LossKind kind{"bone is no node", "bones are no nodes"};
        Skin skin;
        for (unsigned i = 0; i < mesh.mNumBones; ++i) {
            const aiBone& bone = *mesh.mBones[i];
            const auto node = node_by_name_.find(bone.mName.C_Str());
            if (node == node_by_name_.end()) losses_.add(kind, bone.mName.C_Str());
            const bool found = node != node_by_name_.end();
            skin.joints.push_back(found ? node->second : otherwise);
            skin.mesh_to_joint.push_back(found ? to_glm(bone.mOffsetMatrix) : glm::dmat4(1));
        }
        return skin;
    }

    /// Radians from side to side. assimp 5.2 drops Collada's, and takes its own default for degrees.
    double width_of_view(const aiCamera& camera) {
        static const LossKind kind{"camera is without its field of view, and has 45 degrees",
                                   "cameras are without their fields of view, and have 45 degrees"};
        constexpr double least = 0.02; // about a degree
        const auto told = static_cast<double>(camera.mHorizontalFOV);
        if (told > least && told < glm::radians(180.0)) return told;
        losses_.add(kind, camera.mName.C_Str());
        return glm::radians(45.0);
    }

    void add_cameras() {
        for (unsigned i = 0; i < scene_.mNumCameras; ++i) {
            const aiCamera& source = *scene_.mCameras[i];
            const auto node = node_by_name_.find(source.mName.C_Str());
            if (node == node_by_name_.end()) continue;
            const auto vector = [](const aiVector3D& v) {
                return glm::dvec3(static_cast<double>(v.x), static_cast<double>(v.y),
                                  static_cast<double>(v.z));
            };
            NamedCamera camera{{source.mName.C_Str()}, {}};
            camera.camera.parent = node->second;
            camera.camera.position = vector(source.mPosition);
            camera.camera.look_at = camera.camera.position + vector(source.mLookAt);
            camera.camera.up = vector(source.mUp);
            const double aspect = source.mAspect > 0 ? static_cast<double>(source.mAspect) : 1;
            const double width = width_of_view(source);
            const double half = std::tan(width / 2) / aspect;
            camera.camera.vertical_fov = std::clamp(2 * glm::degrees(std::atan(half)), 1.0, 170.0);
            if (source.mClipPlaneNear > 0)
                camera.camera.near_plane = static_cast<double>(source.mClipPlaneNear);
            model_.cameras.push_back(std::move(camera));
        }
    }

    const aiScene& scene_;
    const ObjParts& parts_;
    Losses losses_;
    ModelPictures pictures_;
    Model model_;
    std::vector<std::vector<std::size_t>> uv_sets_; ///< of the materials
    std::map<std::string, std::size_t> node_by_name_;
    std::map<unsigned, std::shared_ptr<const Mesh>> meshes_;
};

/// What went wrong in assimp; a lack of memory leaves as such.
[[noreturn]] void fail(const std::filesystem::path& file, const Assimp::Importer& importer) {
    if (importer.GetException()) {
        try {
            std::rethrow_exception(importer.GetException());
        } catch (const std::bad_alloc&) {
            throw;
        } catch (...) { // NOLINT(bugprone-empty-catch): the message below says it
        }
    }
    throw Error({file.string(), 0, 0, {}, {}},
                fmt::format("can't read this model: {}", importer.GetErrorString()));
}

} // namespace

Model read_with_assimp(const std::filesystem::path& file, const ReadingHooks& hooks) {
    ObjParts parts;
    Assimp::Importer importer;
    // Beside the file, so that the names in it are found from there.
    const std::string alias = (folder_of(file) / ("postfx-model" + usual_ending(file))).string();
    importer.SetIOHandler(new AssetSystem(file, alias, hooks, parts));   // the importer deletes it
    importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, 40); // sharper edges stay edges
    if (!importer.ReadFile(alias, 0)) fail(file, importer);
    prepare_assimp_meshes(*importer.GetScene());
    const aiScene* scene = importer.ApplyPostProcessing(
        aiProcess_Triangulate | aiProcess_GenSmoothNormals | aiProcess_JoinIdenticalVertices
        | aiProcess_SortByPType | aiProcess_ImproveCacheLocality | aiProcess_TransformUVCoords);
    if (!scene || !scene->mRootNode) fail(file, importer);
    return AssimpReader(file, *scene, hooks, parts).read();
}

bool is_model_file(const std::filesystem::path& file) {
    const std::string ending = file.extension().string();
    return !ending.empty() && Assimp::Importer().IsExtensionSupported(ending);
}

} // namespace postfx::host
