// Models by assimp: OBJ with its materials as users write them, STL and PLY.
#include "models.hpp"

#include <catch2/catch.hpp>

#include <postfx/error.hpp>

#include <fstream>

using namespace postfx;
using namespace postfx::host;
using namespace postfx::testing;
using Json = GltfFile::Json;

namespace {

const std::string obj_square = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                               "usemtl m\nf 1/1 2/2 3/3 4/4\n";

void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

/// A square whose only material is made of these lines; t.tga lies beside it.
Model model_with(const std::string& mtl) {
    const TemporaryDirectory folder;
    write_tga(folder / "t.tga", 2, 1, red_green);
    write(folder / "m.mtl", "newmtl m\nKd 1 1 1\n" + mtl);
    write(folder / "m.obj", "mtllib m.mtl\n" + obj_square);
    return load_model(folder / "m.obj");
}

} // namespace

TEST_CASE("OBJ with tabs, indents, bare decimal points and broken lines") {
    const TemporaryDirectory folder;
    write(folder / "m.obj",
          "  v\t-.5 -.5 0\r\n\tv .5  -.5 +.0\r\nv .5 .5 0 \r\nv -.5 .5 0\r\nf 1 2 \\\r\n3 4\r\n");
    const Model model = load_model(folder / "m.obj");
    const Mesh& mesh = only_mesh(model);
    CHECK(mesh.indices.size() == 6);
    CHECK(mesh.bounds().low == glm::dvec3(-0.5, -0.5, 0));
    CHECK(mesh.bounds().high == glm::dvec3(0.5, 0.5, 0));
}

TEST_CASE("mtllib names one library with blanks or several, and every missing one is told") {
    const TemporaryDirectory folder;
    write(folder / "a b.mtl", "newmtl m\nKd .25 .5 1\n");
    const auto color = [&](const std::string& line) {
        write(folder / "m.obj", line + "\n" + obj_square);
        for (const Material& material : load_model(folder / "m.obj").materials) {
            if (material.name == "m") return material.diffuse;
        }
        return glm::vec3(0);
    };
    CHECK(color("mtllib a b.mtl") == glm::vec3(0.25f, 0.5f, 1));
    write(folder / "c.mtl", "newmtl other\n");
    write(folder / "d.mtl", "newmtl m\nKd .5 .5 .5\n");
    CHECK(color("mtllib c.mtl d.mtl") == glm::vec3(0.5f));
    write(folder / "m.obj", "\tmtllib\tc.mtl gone.mtl\n" + obj_square);
    CHECK(load_model(folder / "m.obj").losses.at(0) == "1 material library is missing (gone.mtl)");
}

TEST_CASE("pictures of MTL are scaled and moved, whatever their options and quotes") {
    const Texture texture =
        model_with("map_Kd -cc on -s 2 3 1 -o .25 .5 0 \"t.tga\"  \n").materials.at(1).diffuse_texture;
    REQUIRE(texture);
    // (u, v) = (1, 1) is read at (1, 1) * (2, 3) + (0.25, 0.5).
    CHECK(texture.placement * glm::vec3(1, 1, 1) == glm::vec2(2.25f, 3.5f));
    const Texture once = model_with("map_Kd -s 2 t.tga\n").materials.at(1).diffuse_texture;
    REQUIRE(once);
    CHECK(once.placement * glm::vec3(1, 1, 1) == glm::vec2(2, 1));
    const Texture clamped = model_with("map_Kd -clamp on t.tga\n").materials.at(1).diffuse_texture;
    REQUIRE(clamped);
    CHECK(clamped.sampler.wrap_u == Sampler::Wrap::clamp);
}

TEST_CASE("MTL: transparency with a halo, emission by a picture alone, names in other capitals") {
    CHECK(model_with("d -halo .4\n").materials.at(1).opacity == 0.4f);
    CHECK(model_with("map_Ke t.tga\n").materials.at(1).emission == glm::vec3(1));
    CHECK(model_with("Ke 0 0 0\nmap_Ke t.tga\n").materials.at(1).emission == glm::vec3(0));
    CHECK(model_with("map_Kd T.TGA\n").losses.empty());
}

TEST_CASE("STL without normals has those of its faces, and PLY keeps its colours") {
    const TemporaryDirectory folder;
    write(folder / "m.stl",
          "solid x\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 -1\n"
          "endloop\nendfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
          "vertex 0 1 0\nendloop\nendfacet\nendsolid x\n");
    const Model stl = load_model(folder / "m.stl");
    std::size_t up = 0, forward = 0;
    for (const Vertex& vertex : only_mesh(stl).vertices) {
        up += vertex.normal == glm::vec3(0, 1, 0);
        forward += vertex.normal == glm::vec3(0, 0, 1);
    }
    CHECK(up == 3);
    CHECK(forward == 3);
    write(folder / "m.ply",
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
          "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
          "property list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 255 0 0\n"
          "0 1 0 255 0 0\n3 0 1 2\n");
    const Model ply = load_model(folder / "m.ply");
    CHECK(only_mesh(ply).vertices.at(0).tint == glm::vec3(1, 0, 0));
    // A mirror would have no colour of its own.
    CHECK(ply.materials.at(0).specular == Material().specular);
}

TEST_CASE("a vertex that is not finite does not take its neighbours along") {
    const TemporaryDirectory folder;
    write(folder / "m.ply",
          "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
          "element face 2\nproperty list uchar int vertex_indices\nend_header\nnan 0 0\n1 -1 0\n1 1 0\n"
          "-1 1 0\n3 0 1 2\n3 1 2 3\n");
    const Model model = load_model(folder / "m.ply");
    CHECK(only_mesh(model).indices.size() == 3);
    CHECK(model.losses.at(0) == "1 triangle is left out, for a vertex of it is not finite");
}

TEST_CASE("map_d of OBJ is the opacity") {
    const TemporaryDirectory folder;
    write_tga(folder / "color.tga", 2, 1, red_green);
    write_tga(folder / "mask.tga", 2, 1, {255, 255, 255, 255, 0, 0, 0, 255});
    write_tga(folder / "soft.tga", 2, 1, {100, 100, 100, 255, 50, 50, 50, 255});
    write_tga(folder / "both.tga", 2, 1, {9, 9, 9, 255, 9, 9, 9, 128});
    std::ofstream(folder / "m.obj")
        << "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";
    const auto material = [&](const std::string& lines) {
        std::ofstream(folder / "m.mtl") << "newmtl a\n" << lines;
        return only_mesh(load_model(folder / "m.obj")).empty()
                   ? Material()
                   : load_model(folder / "m.obj").materials.back();
    };
    const auto alphas = [](const Material& of) {
        return std::vector<int>{of.diffuse_texture->rgba.at(3), of.diffuse_texture->rgba.at(7)};
    };
    const Material cut = material("map_Kd color.tga\nmap_d mask.tga\n");
    CHECK(alphas(cut) == std::vector<int>{255, 0});
    CHECK(cut.diffuse_texture->rgba.at(0) == 255);
    CHECK(cut.alpha_cutoff == 0.5f);
    const Material soft = material("map_d soft.tga\n");
    CHECK(alphas(soft) == std::vector<int>{100, 50});
    CHECK(soft.blended);
    const Material same = material("map_Kd both.tga\nmap_d both.tga\n"); // the alpha of the same file
    CHECK(alphas(same) == std::vector<int>{255, 128});
    CHECK(same.blended);
}
