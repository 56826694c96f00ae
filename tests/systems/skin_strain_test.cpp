#include "systems/faces/skin_strain.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace limn::skin_strain_test {

using limn::test::near;

namespace {

const std::vector<Vec3> kTriangle = {{0.1f, 0.2f, 0.3f}, {0.5f, 0.25f, 0.3f}, {0.2f, 0.6f, 0.3f}};
constexpr std::array<std::uint32_t, 3> kCorners = {0, 1, 2};

/// Strain of the triangle in the plane z = 0.3, deformed by `map`.
SkinStrain strain_of(const std::function<Vec3(Vec3)>& map) {
    const SkinTriangles skin = make_skin_triangles(kTriangle, kCorners);
    std::vector<Vec3> deformed;
    for (const Vec3& position : kTriangle) {
        deformed.push_back(map(position));
    }
    std::vector<SkinStrain> strain(skin.area.size());
    find_strain(skin, deformed, strain);
    REQUIRE(strain.size() == 1);
    return strain[0];
}

void check_strain(const SkinStrain& found, float uu, float vv, float uv) {
    CHECK(found.uu == near(uu).epsilon(2e-6).scale(1));
    CHECK(found.vv == near(vv).epsilon(2e-6).scale(1));
    CHECK(found.uv == near(uv).epsilon(2e-6).scale(1));
}

// The faces of ICT FaceKit.

constexpr std::uint32_t kSkinVertices = 9409;

struct ObjFace {
    std::vector<Vec3> positions;         ///< [cm]
    std::vector<std::uint32_t> indices;  ///< quads split along their first diagonal
};

ObjFace read_face(const std::string& path) {
    ObjFace face;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        Vec3 p;
        std::array<unsigned, 4> q = {};
        if (std::sscanf(line.c_str(), "v %f %f %f", &p.x, &p.y, &p.z) == 3) {
            face.positions.push_back(p);
        } else if (
            std::sscanf(line.c_str(), "f %u/%*u %u/%*u %u/%*u %u/%*u", &q[0], &q[1], &q[2], &q[3])
                == 4
            && std::max({q[0], q[1], q[2], q[3]}) <= kSkinVertices) {
            for (const int corner : {0, 1, 2, 0, 2, 3}) {
                face.indices.push_back(q[corner] - 1);
            }
        }
    }
    face.positions.resize(std::min<std::size_t>(face.positions.size(), kSkinVertices));
    return face;
}

/// For each vertex the nearest to its mirror image.
std::vector<std::uint32_t> mirror_of(const std::vector<Vec3>& positions) {
    std::vector<std::uint32_t> mirror(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        float nearest = std::numeric_limits<float>::infinity();
        for (std::size_t j = 0; j < positions.size(); ++j) {
            const Vec3 offset = positions[j] - positions[i] * Vec3{-1, 1, 1};
            const float distance2 = glm::dot(offset, offset);
            if (distance2 < nearest) {
                nearest = distance2;
                mirror[i] = static_cast<std::uint32_t>(j);
            }
        }
    }
    return mirror;
}

/// Whether the centroid `c` [cm] of a triangle at rest with normal z `nz` lies in a region
/// (the project's measured table of regions on the ICT neutral).
bool is_in(const std::string& region, const Vec3& c, float nz) {
    const float x = std::abs(c.x);
    const auto between = [](float a, float value, float b) { return a < value && value < b; };
    if (region == "CF") {
        return between(4.6f, x, 6.4f) && between(2, c.y, 4.8f);
    }
    if (nz <= 0.15f) {
        return false;
    }
    if (region == "NL") {
        const Vec2 a = {1.75f, -0.3f};
        const Vec2 d = Vec2{3.1f, -3} - a;
        const Vec2 p = Vec2{x, c.y} - a;
        return glm::length(p - d * glm::clamp(glm::dot(p, d) / glm::dot(d, d), 0.0f, 1.0f)) < 0.6f;
    }
    return (region == "FH" && x < 5 && between(6.8f, c.y, 10.5f))
           || (region == "GL" && x < 1.4f && between(4.4f, c.y, 6.8f))
           || (region == "NR" && x < 1 && between(2.4f, c.y, 4.4f))
           || (region == "NS" && between(0.5f, x, 1.7f) && between(0.8f, c.y, 2.9f))
           || (region == "UL" && between(2, x, 4.5f) && between(4.3f, c.y, 5.2f))
           || (region == "LL" && between(2, x, 4.4f) && between(1.4f, c.y, 2.8f))
           || (region == "CK" && between(3, x, 6) && between(-2, c.y, 1.2f))
           || (region == "UP" && x < 2 && between(-2.3f, c.y, -1.45f) && c.z > 9.5f)
           || (region == "MC" && between(2.6f, x, 3.8f) && between(-5.2f, c.y, -2.8f))
           || (region == "ML" && x < 2 && between(-5.6f, c.y, -4.7f))
           || (region == "CH" && x < 2 && between(-7.2f, c.y, -5.6f));
}

struct RegionStrain {
    double mean = 0;       ///< of min(lower, 0) [%]
    double below[3] = {};  ///< fraction of area below -5, -10, -20 % [%]
    double theta = 0;      ///< direction of maximum shortening, right side mirrored [deg], 0 .. 180
};

/// The ICT neutral with every shape of the assets, right halves mirrored where absent.
class IctFace {
  public:
    explicit IctFace(std::string folder)
        : folder_(std::move(folder)), neutral_(read_face(folder_ + "generic_neutral_mesh.obj")),
          mirror_(mirror_of(neutral_.positions)),
          skin_(make_skin_triangles(neutral_.positions, neutral_.indices, 0.02f)) {}

    /// Strain of all triangles when the shapes "a+b" are fully on, both halves.
    std::vector<SkinStrain> strain(const std::string& expression) const {
        std::vector<Vec3> deformed = neutral_.positions;
        for (std::size_t first = 0; first < expression.size();) {
            const std::size_t end = std::min(expression.find('+', first), expression.size());
            add(deformed, expression.substr(first, end - first));
            first = end + 1;
        }
        std::vector<SkinStrain> strain(skin_.area.size());
        find_strain(skin_, deformed, strain);
        return strain;
    }

    RegionStrain measure(const std::vector<SkinStrain>& strain, const std::string& region) const {
        RegionStrain found;
        double area = 0;
        double cosine = 0;
        double sine = 0;
        for (std::size_t t = 0; t < strain.size(); ++t) {
            const Vec3 center = (neutral_.positions[skin_.corners[3 * t]]
                                 + neutral_.positions[skin_.corners[3 * t + 1]]
                                 + neutral_.positions[skin_.corners[3 * t + 2]])
                                / 3.0f;
            if (!is_in(region, center, glm::cross(skin_.u[t], skin_.v[t]).z)) {
                continue;
            }
            const PrincipalStrain p = principal_strain(strain[t]);
            const double angle = center.x < 0 ? kPi - p.angle : p.angle;
            const double shortening = std::max(-p.lower, 0.0f);
            area += skin_.area[t];
            found.mean -= 100 * skin_.area[t] * shortening;
            cosine += skin_.area[t] * shortening * std::cos(2 * angle);
            sine += skin_.area[t] * shortening * std::sin(2 * angle);
            for (int k = 0; k < 3; ++k) {
                constexpr double kLimits[3] = {0.05, 0.1, 0.2};
                found.below[k] += shortening > kLimits[k] ? 100 * skin_.area[t] : 0;
            }
        }
        REQUIRE(area > 0);
        found.mean /= area;
        for (double& fraction : found.below) {
            fraction /= area;
        }
        found.theta = std::fmod(0.5 * std::atan2(sine, cosine) * 180 / kPi + 180, 180);
        return found;
    }

  private:
    void add(std::vector<Vec3>& deformed, const std::string& shape) const {
        const bool halves = !std::ifstream(folder_ + shape + ".obj");
        const ObjFace left = read_face(folder_ + shape + (halves ? "_L.obj" : ".obj"));
        REQUIRE(left.positions.size() == neutral_.positions.size());
        const bool mirrored = halves && !std::ifstream(folder_ + shape + "_R.obj");
        const ObjFace right =
            halves && !mirrored ? read_face(folder_ + shape + "_R.obj") : ObjFace{};
        for (std::size_t i = 0; i < deformed.size(); ++i) {
            deformed[i] += left.positions[i] - neutral_.positions[i];
            if (mirrored) {
                const std::uint32_t j = mirror_[i];
                deformed[i] += (left.positions[j] - neutral_.positions[j]) * Vec3{-1, 1, 1};
            } else if (halves) {
                deformed[i] += right.positions[i] - neutral_.positions[i];
            }
        }
    }

    std::string folder_;
    ObjFace neutral_;
    std::vector<std::uint32_t> mirror_;
    SkinTriangles skin_;
};

}  // namespace

TEST_CASE("skin_strain: a mesh at rest has none") {
    check_strain(strain_of([](Vec3 p) { return p; }), 0, 0, 0);
}

TEST_CASE("skin_strain: stretches along the axes are found exactly" * technique("face.strain")) {
    const SkinStrain strain = strain_of([](Vec3 p) { return p * Vec3{0.8f, 1.05f, 1}; });
    check_strain(strain, -0.2f, 0.05f, 0);
    const PrincipalStrain principal = principal_strain(strain);
    CHECK(principal.lower == near(-0.2).epsilon(1e-5));
    CHECK(principal.higher == near(0.05).epsilon(1e-4));
    CHECK(std::abs(std::sin(principal.angle)) < 1e-4);  // along x
}

TEST_CASE(
    "skin_strain: uniform scaling by 0.9 is -0.1 in all directions" * technique("face.strain")) {
    check_strain(strain_of([](Vec3 p) { return 0.9f * p; }), -0.1f, -0.1f, 0);
}

TEST_CASE("skin_strain: rigid motion has none" * technique("face.strain")) {
    const Quat turn = glm::angleAxis(radians(10), Vec3{0, 0, 1});
    check_strain(strain_of([&](Vec3 p) { return turn * p; }), 0, 0, 0);
    const Quat tumble = glm::angleAxis(2.0f, glm::normalize(Vec3{1, -2, 3}));
    check_strain(strain_of([&](Vec3 p) { return tumble * p + Vec3{1, 2, 3}; }), 0, 0, 0);
}

TEST_CASE("skin_strain: compression along a slanted direction keeps its angle") {
    for (const float angle : {-80.0f, -45.0f, 10.0f, 30.0f, 60.0f}) {
        const Vec3 d = {std::cos(radians(angle)), std::sin(radians(angle)), 0};
        const SkinStrain strain = strain_of([&](Vec3 p) { return p - 0.3f * glm::dot(p, d) * d; });
        const PrincipalStrain principal = principal_strain(strain);
        CHECK(principal.lower == near(-0.3).epsilon(1e-5));
        CHECK(degrees(principal.angle) == near(angle).epsilon(1e-4));
    }
}

TEST_CASE("skin_strain: degenerate and non-finite triangles are skipped") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {nan, 0, 0}};
    const std::vector<std::uint32_t> indices = {0, 1, 3, 0, 1, 4, 0, 1, 9, 0, 0, 1, 0, 1, 2};
    const SkinTriangles skin = make_skin_triangles(positions, indices);
    CHECK(skin.source == std::vector<std::uint32_t>{4});
    std::vector<Vec3> deformed = positions;
    deformed[2].y = nan;
    std::vector<SkinStrain> strain(1);
    find_strain(skin, deformed, strain);
    check_strain(strain[0], 0, 0, 0);
}

TEST_CASE("skin_strain: triangles with an edge below the limit are skipped") {
    const std::vector<Vec3> sliver = {{0, 0, 0}, {1e-4f, 0, 0}, {0, 0.01f, 0}};
    CHECK(make_skin_triangles(sliver, kCorners).source.empty());
    CHECK(make_skin_triangles(sliver, kCorners, 5e-5f).source.size() == 1);
}

TEST_CASE("skin_strain: vertices duplicated along a seam get one average") {
    // Two triangles side by side, whose common edge has its own vertices on each side.
    const std::vector<Vec3> rest = {{0, 0, 0},     {1, 0, 0}, {0, 1, 0},
                                    {1, -0.0f, 0}, {1, 1, 0}, {0, 1, 0}};
    const std::vector<std::uint32_t> indices = {0, 1, 2, 3, 4, 5};
    const SkinTriangles skin = make_skin_triangles(rest, indices);
    CHECK(skin.welded == std::vector<std::uint32_t>{0, 1, 2, 1, 4, 2});
    std::vector<Vec3> deformed = rest;
    deformed[4] = {0.8f, 0.8f, 0};
    std::vector<SkinStrain> strain(2);
    find_strain(skin, deformed, strain);
    std::vector<SkinStrain> vertices(rest.size());
    average_strain(skin, strain, vertices);
    CHECK(strain[1].uu < -0.1f);
    for (const auto& [a, b] : {std::pair{1, 3}, std::pair{2, 5}}) {
        CHECK(vertices[a].uu == near(0.5f * (strain[0].uu + strain[1].uu)).epsilon(1e-5));
        CHECK(vertices[a].uu == vertices[b].uu);
        CHECK(vertices[a].vv == vertices[b].vv);
        CHECK(vertices[a].uv == vertices[b].uv);
    }
}

TEST_CASE("skin_strain: an average is that of tensors in space, weighted by area") {
    // A pyramid without base, whose sides differ in area and normal.
    const std::vector<Vec3> rest = {
        {0.1f, 0.2f, 1}, {1, -0.3f, 0}, {0.2f, 1.4f, 0.1f}, {-0.5f, -0.4f, 0.3f}};
    const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 2, 3, 0, 3, 1};
    const SkinTriangles skin = make_skin_triangles(rest, indices);
    const std::vector<SkinStrain> strain = {
        {.uu = -0.3f, .vv = 0.1f, .uv = 0.05f},
        {.uu = 0.2f, .vv = -0.1f, .uv = -0.15f},
        {.uu = 0.05f, .vv = -0.25f, .uv = 0.1f}};
    REQUIRE(skin.area.size() == strain.size());
    glm::dmat3 sum(0.0);
    double area = 0;
    for (std::size_t t = 0; t < strain.size(); ++t) {
        const glm::dvec3 u = skin.u[t];
        const glm::dvec3 v = skin.v[t];
        const SkinStrain& s = strain[t];
        const glm::dmat3 uv = glm::outerProduct(u, v);
        const glm::dmat3 tensor = double(s.uu) * glm::outerProduct(u, u)
                                  + double(s.vv) * glm::outerProduct(v, v)
                                  + double(s.uv) * (uv + glm::transpose(uv));
        sum += double(skin.area[t]) * tensor;
        area += skin.area[t];
    }
    std::vector<SkinStrain> vertices(rest.size());
    average_strain(skin, strain, vertices);
    const glm::dvec3 u = skin.vertex_u[0];
    const glm::dvec3 v = skin.vertex_v[0];
    check_strain(
        vertices[0], float(glm::dot(u, sum * u) / area), float(glm::dot(v, sum * v) / area),
        float(glm::dot(u, sum * v) / area));
}

TEST_CASE("skin_strain: a triangle whose normal points up has strain like any other") {
    const std::vector<Vec3> floor = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.2f}};
    const SkinTriangles skin = make_skin_triangles(floor, kCorners);
    const std::vector<Vec3> deformed = {{0, 0, 0}, {0, 0, 0.9f}, {0.9f, 0, 0.18f}};
    std::vector<SkinStrain> strain(skin.area.size());
    find_strain(skin, deformed, strain);
    REQUIRE(strain.size() == 1);
    check_strain(strain[0], -0.1f, -0.1f, 0);
    CHECK(std::abs(glm::dot(skin.u[0], Vec3{0, 1, 0})) < 1e-6f);
    CHECK(glm::length(skin.u[0]) == near(1).epsilon(1e-6));
}

TEST_CASE("skin_strain: real faces are compressed where anatomy says") {
    const auto folder = limn::test::shared_asset("ict-facekit/FaceXModel/");
    if (!folder) {
        return;
    }
    struct Row {
        const char* expression;
        const char* region;
        double below[3];
        double mean;
        double theta;  ///< < 0: not stated
    };
    // Measured on this mesh with quads split along their first diagonal.
    const Row rows[] = {
        {"browInnerUp+browOuterUp", "FH", {91, 81, 64}, -24.1, 83},
        {"browInnerUp", "FH", {86, 56, 24}, -12.9, 86},
        {"browInnerUp", "GL", {67, 43, 0}, -8.5, 106},
        {"browOuterUp", "FH", {66, 45, 26}, -11.9, 81},
        {"browDown", "GL", {100, 97, 35}, -18.1, 20},
        {"browDown", "NR", {35, 21, 0}, -4.4, 65},
        {"browDown", "UL", {100, 87, 48}, -22.4, 46},
        {"browDown", "FH", {38, 10, 0}, -4.5, 161},
        {"eyeBlink", "LL", {47, 33, 7}, -7.5, 27},
        {"eyeBlink", "CF", {12, 8, 4}, -3.1, -1},
        {"eyeSquint", "LL", {54, 28, 3}, -6.8, 152},
        {"eyeSquint", "CF", {38, 16, 0}, -5.2, 100},
        {"mouthSmile", "NL", {81, 67, 54}, -18.6, 63},
        {"mouthSmile", "CK", {78, 44, 5}, -9.6, 57},
        {"mouthSmile", "LL", {90, 64, 6}, -11.7, 83},
        {"mouthSmile", "CF", {48, 25, 0}, -6.3, 90},
        {"mouthSmile", "MC", {100, 99, 46}, -20.7, -1},
        {"mouthSmile", "UP", {100, 100, 80}, -21.7, 80},
        {"noseSneer", "NS", {100, 98, 81}, -25.7, 119},
        {"noseSneer", "NR", {100, 100, 64}, -22.1, 94},
        {"noseSneer", "LL", {100, 100, 97}, -28.9, 93},
        {"noseSneer", "UL", {89, 82, 52}, -19.8, 90},
        {"noseSneer", "NL", {93, 73, 11}, -13.4, 178},
        {"mouthPucker", "UP", {100, 91, 16}, -15.5, 155},
        {"mouthPucker", "ML", {100, 94, 0}, -13.7, 5},
        {"mouthPucker", "NL", {89, 74, 10}, -13.2, 140},
        {"mouthFunnel", "NL", {88, 51, 6}, -10.3, 145},
        {"jawOpen", "CH", {100, 100, 3}, -15.6, 123},
        {"jawOpen", "MC", {87, 57, 24}, -13.3, 161},
        {"cheekPuff", "LL", {100, 69, 3}, -12.1, 106},
        {"cheekPuff", "UP", {100, 83, 3}, -13.3, 164},
    };
    const IctFace face(*folder);
    for (const Row& row : rows) {
        const RegionStrain found = face.measure(face.strain(row.expression), row.region);
        CAPTURE(row.expression);
        CAPTURE(row.region);
        CHECK(std::abs(found.mean - row.mean) <= 0.5);
        for (int k = 0; k < 3; ++k) {
            CAPTURE(k);
            CHECK(std::abs(found.below[k] - row.below[k]) <= 4);
        }
        if (row.theta >= 0) {
            CHECK(std::abs(std::remainder(found.theta - row.theta, 180.0)) <= 2);
        }
    }

    const std::map<std::string, std::vector<std::string>> quiet = {
        {"mouthSmile", {"FH", "GL", "NR", "UL"}},
        {"mouthPucker", {"FH", "GL", "NR", "UL", "CF"}},
        {"mouthFunnel", {"FH", "GL", "NR", "UL", "CF"}},
        {"jawOpen", {"FH", "GL", "NR", "NS", "UL", "LL", "CF"}},
        {"eyeBlink", {"FH", "GL", "NR", "NS", "UL", "CK", "NL", "UP", "MC", "ML", "CH"}},
        {"eyeSquint", {"FH", "GL", "NR", "NL", "UP", "ML", "CH"}},
        {"browDown", {"NS", "LL", "CK", "NL", "UP", "MC", "ML", "CH"}},
        {"browInnerUp+browOuterUp", {"CK", "NL", "UP", "MC", "ML", "CH"}},
    };
    for (const auto& [expression, regions] : quiet) {
        const std::vector<SkinStrain> strain = face.strain(expression);
        for (const std::string& region : regions) {
            const std::string where = expression + " " + region;
            CAPTURE(where);
            CHECK(std::abs(face.measure(strain, region).mean) < 1);
        }
    }
}

}  // namespace limn::skin_strain_test
