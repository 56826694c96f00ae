#include "systems/faces/skin_strain.h"
#include "systems/faces/wrinkle_measure.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <vector>

namespace limn::wrinkle_driver_test {

using limn::test::near;

namespace {

using Positions = std::vector<Vec3>;

struct Sheet {
    Positions positions;
    std::vector<std::uint32_t> indices;
};

/// 5 x 5 vertices in the plane z = 0.
Sheet make_sheet() {
    Sheet sheet;
    for (std::uint32_t y = 0; y < 5; ++y) {
        for (std::uint32_t x = 0; x < 5; ++x) {
            sheet.positions.emplace_back(x, y, 0);
            if (x < 4 && y < 4) {
                const std::uint32_t v = 5 * y + x;
                sheet.indices.insert(sheet.indices.end(), {v, v + 1, v + 5, v + 1, v + 6, v + 5});
            }
        }
    }
    return sheet;
}

Positions mapped(const Positions& positions, const std::function<Vec3(Vec3)>& map) {
    Positions result;
    std::ranges::transform(positions, std::back_inserter(result), map);
    return result;
}

/// Compression in the direction of least stretch, with the axes of SkinTriangles.
std::vector<WrinkleRest>
strain_rests(const Sheet& sheet, WrinkleWeight weight = WrinkleWeight::Angle) {
    const SkinTriangles skin = make_skin_triangles(sheet.positions, sheet.indices, 0);
    std::vector<Vec3> normals;
    for (std::size_t v = 0; v < sheet.positions.size(); ++v) {
        normals.push_back(glm::cross(skin.vertex_u[v], skin.vertex_v[v]));
    }
    const std::array<WrinkleRest, 3> rests =
        make_strain_rest(sheet.positions, sheet.indices, skin.vertex_u, normals, weight);
    return {rests.begin(), rests.end()};
}

std::vector<WrinkleRest> chord_rests(const Sheet& sheet, const Vec3& across) {
    return {make_wrinkle_rest(
        sheet.positions, sheet.indices, std::vector<Vec3>(sheet.positions.size(), across))};
}

}  // namespace

TEST_CASE(
    "wrinkle driver: edges react to a shear that does not change the chord"
    * technique("wrinkle.compression.prior-models")) {
    const Sheet sheet = make_sheet();
    const Positions sheared = mapped(sheet.positions, [](Vec3 p) {
        return p + Vec3{0.7f * p.y, 0, 0};
    });
    const std::vector<WrinkleRest> edges = {make_edge_rest(sheet.positions, sheet.indices)};
    for (const float ratio : vertex_compression(edges, sheet.positions)) {
        CHECK(ratio == near(1));
    }
    const std::size_t center = 12;
    CHECK(vertex_compression(chord_rests(sheet, {1, 0, 0}), sheared)[center] == near(1));
    CHECK(std::abs(vertex_compression(edges, sheared)[center] - 1) > 0.05f);

    // A vertex between two right triangles: edges along x and y, each with half of the weight.
    const Sheet corner = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}};
    const std::vector<WrinkleRest> one = {make_edge_rest(corner.positions, corner.indices)};
    const Positions shorter = mapped(corner.positions, [](Vec3 p) {
        return Vec3{0.5f * p.x, p.y, 0};
    });
    CHECK(vertex_compression(one, shorter)[0] == near(0.5 * (0.25 + 1)));
}

TEST_CASE(
    "wrinkle driver: strain finds the direction of least stretch, whatever it is"
    * technique("face.strain")) {
    const Sheet sheet = make_sheet();
    const std::vector<WrinkleRest> rests = strain_rests(sheet);
    for (int degrees = 0; degrees < 180; degrees += 15) {
        const float angle = radians(static_cast<float>(degrees));
        const Vec3 along = {std::cos(angle), std::sin(angle), 0};
        // Shorter by 0.8 along a direction, longer by 1.05 across it, then moved rigidly.
        const Positions deformed = mapped(sheet.positions, [&](Vec3 p) {
            const Vec3 moved = 1.05f * p + (0.8f - 1.05f) * glm::dot(p, along) * along;
            return Vec3{moved.y, 0.6f * moved.x + 2, 0.8f * moved.x};
        });
        for (const float ratio : vertex_compression(rests, deformed)) {
            CHECK(ratio == near(0.64));
        }
    }
    for (const float ratio :
         vertex_compression(rests, mapped(sheet.positions, [](Vec3 p) { return 0.9f * p; }))) {
        CHECK(ratio == near(0.81));
    }
    for (const float ratio : vertex_compression(rests, sheet.positions)) {
        CHECK(ratio == near(1));
    }
}

TEST_CASE(
    "wrinkle driver: strain at vertices is that of skin_strain where it is small"
    * technique("face.strain")) {
    Sheet sheet = make_sheet();
    sheet.positions = mapped(sheet.positions, [](Vec3 p) {  // of a cylinder
        return Vec3{2 * std::sin(0.1f * p.x), 0.2f * p.y, 2 * std::cos(0.1f * p.x)};
    });
    const auto swell = [](Vec3 p) {
        return p * (1 + 0.004f * std::sin(5 * p.x + 3 * p.y) + 0.003f * std::cos(4 * p.z));
    };
    const Positions deformed = mapped(sheet.positions, swell);
    const SkinTriangles skin = make_skin_triangles(sheet.positions, sheet.indices, 0);
    std::vector<SkinStrain> triangles(skin.area.size());
    find_strain(skin, deformed, triangles);
    std::vector<SkinStrain> vertices(sheet.positions.size());
    average_strain(skin, triangles, vertices);
    const std::vector<float> ratio =
        vertex_compression(strain_rests(sheet, WrinkleWeight::Area), deformed);
    float largest = 0;
    float strongest = 0;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const float lower = principal_strain(vertices[v]).lower;
        largest = std::max(largest, std::abs(std::sqrt(ratio[v]) - 1 - lower));
        strongest = std::max(strongest, std::abs(lower));
    }
    CHECK(strongest > 0.003f);
    CHECK(largest < 0.03f * strongest);
}

TEST_CASE(
    "wrinkle driver: the strain of a tensor is its root less 1, in any axes"
    * technique("face.strain")) {
    // Shorter by 0.8 along u, longer by 1.05 along v; Green's strain would be -0.18 and 0.05125.
    const SkinStrain tensor = tensor_of_ratios(0.64f, 1.1025f, 0.5f * (0.64f + 1.1025f));
    const SkinStrain along = strain_of_tensor(tensor, 0, 1);
    CHECK(along.uu == near(-0.2));
    CHECK(along.vv == near(0.05));
    CHECK(along.uv == near(0).scale(1));
    const SkinStrain across = strain_of_tensor(tensor, radians(90.0f), 1);
    CHECK(across.uu == near(0.05));
    CHECK(across.vv == near(-0.2));
    for (const float side : {1.0f, -1.0f}) {
        for (float angle = -3; angle < 3; angle += 0.4f) {
            const SkinStrain turned = strain_of_tensor(tensor, angle, side);
            const PrincipalStrain principal = principal_strain(turned);
            CHECK(principal.lower == near(-0.2));
            CHECK(principal.higher == near(0.05));
            // The direction of compression is still the axis u.
            CHECK(std::abs(std::cos(side * principal.angle + angle)) == near(1));
            // Rotated back, it is the original tensor.
            const SkinStrain squared = {
                .uu = square(1 + turned.uu) + square(turned.uv),
                .vv = square(1 + turned.vv) + square(turned.uv),
                .uv = turned.uv * (2 + turned.uu + turned.vv)};
            const SkinStrain back = strain_of_tensor(squared, -side * angle, side);
            CHECK(back.uu == near(-0.2));
            CHECK(back.vv == near(0.05));
        }
    }
}

TEST_CASE(
    "wrinkle driver: means of squares exceed squares of means by the variance"
    * technique("wrinkle.compression.square-length")) {
    // Four right triangles about a vertex, shorter by 0.8, 0.9, 1 and 0.7.
    const Sheet fan = {
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
        {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1}};
    std::vector<WrinkleRest> rests = chord_rests(fan, {1, 0, 0});
    const std::vector<float> ratio = {0.64f, 0.81f, 1, 0.49f};
    std::vector<float> vertices(5);
    average_compression(rests[0], ratio, vertices);
    CHECK(vertices[0] == near(0.735));
    rests[0].mean_length = true;
    average_compression(rests[0], ratio, vertices);
    CHECK(vertices[0] == near(0.7225));
    average_compression(rests[0], std::vector<float>(4, 0.36f), vertices);
    CHECK(vertices[0] == near(0.36));
}

}  // namespace limn::wrinkle_driver_test
