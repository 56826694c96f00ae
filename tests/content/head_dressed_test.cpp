// A head that wears a shirt lacks the skin below it.

#include "content/make/head/head.h"
#include "ecs/components/surface.h"

#include <doctest/doctest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace limn::head_dressed_test {
namespace {

constexpr std::uint16_t kShouldersJoint = 4;

HeadShape person(float sex, float build) {
    HeadShape shape;
    shape.sex = sex;
    shape.build = build;
    shape.shoulders = true;
    return shape;
}

struct Person {
    MeshData whole, dressed, shirt;
};

Person make_person(HeadShape shape) {
    Person made;
    made.whole = make_head(shape);
    shape.dressed = true;
    made.dressed = make_head(shape);
    shape.part = HeadPartKind::Shirt;
    made.shirt = make_head(shape);
    return made;
}

const Person& neutral() {
    static const Person made = [] {
        HeadShape shape = person(0, 0);
        shape.grows_old = true;
        return make_person(shape);
    }();
    return made;
}

/// Positions of a head rotated by `turn` about the origin, while the shoulders stay, with morph
/// `target` at weight 1; -1: none.
std::vector<Vec3> posed(const MeshData& mesh, const Quat& turn, int target) {
    std::vector<Vec3> positions = mesh.positions;
    if (target >= 0) {
        const MorphTarget& morph = mesh.morphs[static_cast<std::size_t>(target)];
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            positions[morph.vertices[i]] += morph.positions[i];
        }
    }
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        float turning = 1;
        for (std::uint32_t i = mesh.skin.first[v]; i < mesh.skin.first[v + 1]; ++i) {
            turning -= mesh.skin.joints[i] == kShouldersJoint ? mesh.skin.weights[i] : 0.0f;
        }
        positions[v] = glm::mix(positions[v], turn * positions[v], turning);
    }
    return positions;
}

/// An orthographic view of 70 cm with a depth buffer.
class DepthView {
  public:
    explicit DepthView(const Vec3& toward)
        : toward_(toward), right_(glm::normalize(glm::cross(
                               std::abs(toward.y) < 0.9f ? Vec3(0, 1, 0) : Vec3(1, 0, 0), toward))),
          up_(glm::cross(toward, right_)), height(kSize * kSize, -1.0f) {}

    /// The triangles that face the viewer.
    void draw(const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& indices) {
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            const Vec3 a = project(positions[indices[i]]);
            const Vec3 b = project(positions[indices[i + 1]]);
            const Vec3 c = project(positions[indices[i + 2]]);
            const float area = cross(b - a, c - a);
            if (area > 0) {
                fill(a, b, c, area);
            }
        }
    }

  private:
    static constexpr int kSize = 175;
    static constexpr float kPixel = 0.004f;  // [m]
    static constexpr float kEdge = 0.01f;    // so that rounding causes no cracks between triangles

    static float cross(const Vec3& a, const Vec3& b) { return a.x * b.y - a.y * b.x; }

    Vec3 project(const Vec3& p) const {
        const Vec3 from = p - Vec3(0, -0.08f, 0);
        return {
            0.5f * kSize + glm::dot(from, right_) / kPixel,
            0.5f * kSize + glm::dot(from, up_) / kPixel, glm::dot(from, toward_)};
    }

    void fill(const Vec3& a, const Vec3& b, const Vec3& c, float area) {
        const Vec3 low = glm::max(glm::min(glm::min(a, b), c), Vec3(0));
        const Vec3 high = glm::min(glm::max(glm::max(a, b), c), Vec3(kSize - 1));
        for (int y = static_cast<int>(low.y); y <= static_cast<int>(high.y); ++y) {
            for (int x = static_cast<int>(low.x); x <= static_cast<int>(high.x); ++x) {
                const Vec3 at = Vec3(x, y, 0) + Vec3(0.5f, 0.5f, 0);
                const float of_a = cross(c - b, at - b);
                const float of_b = cross(a - c, at - c);
                const float of_c = cross(b - a, at - a);
                if (std::min({of_a, of_b, of_c}) > -kEdge) {
                    float& nearest = height[static_cast<std::size_t>(y * kSize + x)];
                    nearest = std::max(nearest, (of_a * a.z + of_b * b.z + of_c * c.z) / area);
                }
            }
        }
    }

    Vec3 toward_, right_, up_;

  public:
    std::vector<float> height;
};

/// Number of pixels, in views from all sides and from slightly below but not into the shirt, that
/// show skin which the dressed head lacks.
int pixels_missing(const Person& who, const Quat& turn, int target) {
    constexpr int kViews = 24;
    constexpr float kLowest = -0.25f;
    const std::vector<Vec3> whole = posed(who.whole, turn, target);
    const std::vector<Vec3> dressed = posed(who.dressed, turn, target);
    int missing = 0;
    for (int i = 0; i < kViews; ++i) {  // evenly over the sphere above its hem
        const float y = 1 - (1 - kLowest) * (static_cast<float>(i) + 0.5f) / kViews;
        const float around = 2.399963f * static_cast<float>(i);
        const float ring = std::sqrt(1 - y * y);
        const Vec3 toward = {ring * std::cos(around), y, ring * std::sin(around)};
        DepthView all(toward);
        all.draw(who.shirt.positions, who.shirt.indices);
        DepthView some = all;
        all.draw(whole, who.whole.indices);
        some.draw(dressed, who.dressed.indices);
        for (std::size_t k = 0; k < all.height.size(); ++k) {
            missing += all.height[k] != some.height[k] ? 1 : 0;
        }
    }
    return missing;
}

TEST_CASE("dressed head: no skin is missing from any side, however the head turns, of any body") {
    const std::array<Quat, 5> turns = {
        Quat(1, 0, 0, 0), glm::angleAxis(0.9f, Vec3(0, 1, 0)),
        glm::angleAxis(-0.9f, glm::normalize(Vec3(0.3f, 1, 0))),
        glm::angleAxis(-0.6f, Vec3(1, 0, 0)), glm::angleAxis(0.5f, Vec3(0, 0, 1))};
    for (const Quat& turn : turns) {
        CHECK(pixels_missing(neutral(), turn, -1) == 0);
    }
    for (const auto& [sex, build] : {std::pair(1.0f, 1.0f), std::pair(-1.0f, -1.0f)}) {
        const Person who = make_person(person(sex, build));
        CHECK(pixels_missing(who, turns[0], -1) == 0);
        CHECK(pixels_missing(who, turns[1], -1) == 0);
    }
}

TEST_CASE("dressed head: its triangles are some of the whole one, and no shape moves the others") {
    const MeshData& whole = neutral().whole;
    const MeshData& dressed = neutral().dressed;
    CHECK(dressed.indices.size() < 0.92 * static_cast<double>(whole.indices.size()));
    CHECK(dressed.bounds.min.y > whole.bounds.min.y + 0.02f);
    REQUIRE(dressed.morphs.size() == whole.morphs.size());
    const auto key = [](const MeshData& mesh, std::uint32_t v) {
        return std::array<float, 3>{mesh.uvs[v].x, mesh.uvs[v].y, mesh.tangents[v].w};
    };
    std::map<std::array<float, 3>, std::uint32_t> by_key;
    for (std::uint32_t v = 0; v < whole.positions.size(); ++v) {
        by_key[key(whole, v)] = v;
    }
    std::vector<std::uint32_t> source;
    for (std::uint32_t v = 0; v < dressed.positions.size(); ++v) {
        source.push_back(by_key.at(key(dressed, v)));
        const std::uint32_t w = source.back();
        CHECK(dressed.positions[v] == whole.positions[w]);
        CHECK(dressed.normals[v] == whole.normals[w]);
        CHECK(dressed.tangents[v] == whole.tangents[w]);
        CHECK(dressed.uvs1[v] == whole.uvs1[w]);
        CHECK(dressed.colors[v] == whole.colors[w]);
    }
    for (std::size_t i = 0; i < dressed.regions.size(); ++i) {
        for (std::uint32_t v = 0; v < dressed.positions.size(); ++v) {
            CHECK(dressed.regions[i].weights[v] == whole.regions[i].weights[source[v]]);
        }
    }
    for (std::size_t i = 0; i < dressed.morphs.size(); ++i) {
        REQUIRE(dressed.morphs[i].vertices.size() == whole.morphs[i].vertices.size());
        std::map<std::uint32_t, Vec3> offsets;
        for (std::size_t k = 0; k < whole.morphs[i].vertices.size(); ++k) {
            offsets[whole.morphs[i].vertices[k]] = whole.morphs[i].positions[k];
        }
        for (std::size_t k = 0; k < dressed.morphs[i].vertices.size(); ++k) {
            CHECK(
                offsets.at(source[dressed.morphs[i].vertices[k]])
                == dressed.morphs[i].positions[k]);
        }
    }
}

}  // namespace
}  // namespace limn::head_dressed_test
