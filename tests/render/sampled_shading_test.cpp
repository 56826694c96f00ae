#include "tests/render/laboratory_fixture.h"
#include "tests/technique.h"

#include <cstdint>

namespace limn::test::sampled_shading_test {
namespace {

/// Each triangle in four, at midpoints with the normalized sum of the normals.
MeshData subdivide(const MeshData& mesh) {
    MeshData result = mesh;
    result.indices.clear();
    const auto middle = [&result](std::uint32_t a, std::uint32_t b) {
        result.positions.push_back(0.5f * (result.positions[a] + result.positions[b]));
        result.normals.push_back(glm::normalize(result.normals[a] + result.normals[b]));
        result.tangents.push_back(result.tangents[a]);
        result.uvs.push_back(0.5f * (result.uvs[a] + result.uvs[b]));
        return static_cast<std::uint32_t>(result.positions.size() - 1);
    };
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::uint32_t a = mesh.indices[i];
        const std::uint32_t b = mesh.indices[i + 1];
        const std::uint32_t c = mesh.indices[i + 2];
        const std::uint32_t ab = middle(a, b);
        const std::uint32_t bc = middle(b, c);
        const std::uint32_t ca = middle(c, a);
        result.indices.insert(result.indices.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    return result;
}

}  // namespace

TEST_CASE_FIXTURE(
    Laboratory,
    "shading rates: a triangle matches the laboratory, to within 1/255"
        * technique("fakephong.blinn-map, fakephong.cubic, fakephong.envmap, fakephong.gouraud, "
                    "fakephong.gouraud-subdivided, fakephong.hw-blinn, fakephong.hw-quadratic, "
                    "fakephong.normal-interp-variants, fakephong.phong, fakephong.phong-map, "
                    "fakephong.quadratic, fakephong.quadratic-blinn, fakephong.taylor")) {
    show(make_spread_triangle());
    point_light({0.3f, 0.2f, 2});
    compare_all();
}

TEST_CASE_FIXTURE(
    Laboratory,
    "shading rates: a coarse ball under three lights matches the laboratory"
        * technique("fakephong.blinn-map, fakephong.cubic, fakephong.envmap, fakephong.gouraud, "
                    "fakephong.gouraud-subdivided, fakephong.hw-blinn, fakephong.hw-quadratic, "
                    "fakephong.normal-interp-variants, fakephong.phong, fakephong.phong-map, "
                    "fakephong.quadratic, fakephong.quadratic-blinn, fakephong.taylor")) {
    show(make_ball(8));
    directional_light({0.2f, 0.4f, 1});  // the first: the renderer sorts lights by kind
    point_light({0.6f, 1.5f, 3});
    point_light({-1, -0.5f, 3});
    compare_all();
}

TEST_CASE_FIXTURE(
    Laboratory, "shading rates: subdivided is per vertex on a mesh of four times the triangles"
                    * technique("fakephong.barycentric, fakephong.gouraud-subdivided")) {
    const MeshData ball = make_ball(6);
    show(ball);
    point_light({0.6f, 0.9f, 2.5f});
    const gpu::FloatImage subdivided = drawn(ShadingRate::Subdivided);
    const gpu::FloatImage coarse = drawn(ShadingRate::Vertex);
    world.get<MeshInstance>(object).mesh = add(subdivide(ball));
    const gpu::FloatImage fine = drawn(ShadingRate::Vertex);
    CHECK(largest_difference(subdivided, fine) < 2e-3f);
    CHECK(largest_difference(coarse, fine) > 0.02f);
}

TEST_CASE_FIXTURE(
    Laboratory, "shading rates: normals that cancel at a midpoint are replaced by the face normal"
                    * technique("fakephong.quadratic")) {
    MeshData mesh = make_square();
    mesh.normals = {{1, 0, 0}, {-1, 0, 0}, {0, 0.6f, 0.8f}, {0, 0, 1}};
    mesh.indices = {0, 1, 2};
    show(mesh);
    directional_light({0, 0.2f, 1});  // behind no vertex: the renderer has no highlights there
    // At two vertices N.L is 0, and rounding decides whether hw-quadratic has a highlight there:
    // hardware fuses other operations.
    compare_all(device().caps().software ? kStep : 2 * kStep);
}

}  // namespace limn::test::sampled_shading_test
