// The shapes of a generated person's face.

#include "content/make/person/person.h"
#include "content/make/person/person_face.h"
#include "tests/content/mesh_laws.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace limn::person_face_test {

using namespace test;

namespace {

PersonShape skin_of(int seed) {
    return {.part = PersonPart::Skin, .seed = seed, .sleeves = PersonSleeves::Long};
}

const MorphTarget& shape_called(const MeshData& mesh, std::string_view name) {
    const auto found = std::ranges::find(mesh.morphs, name, &MorphTarget::name);
    REQUIRE(found != mesh.morphs.end());
    return *found;
}

MeshData with_shape(MeshData mesh, std::string_view name, float weight) {
    const MorphTarget& shape = shape_called(mesh, name);
    for (std::size_t i = 0; i < shape.vertices.size(); ++i) {
        mesh.positions[shape.vertices[i]] += weight * shape.positions[i];
    }
    return mesh;
}

/// z of the foremost surface at (x, y); -1 where there is none.
float front_at(const MeshData& mesh, float x, float y) {
    float front = -1;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Vec3& a = mesh.positions[mesh.indices[i]];
        const Vec3& b = mesh.positions[mesh.indices[i + 1]];
        const Vec3& c = mesh.positions[mesh.indices[i + 2]];
        const Vec3 n = glm::cross(b - a, c - a);
        const auto side = [&](const Vec3& p, const Vec3& q) {
            return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
        };
        if (n.z > 0 && side(a, b) >= 0 && side(b, c) >= 0 && side(c, a) >= 0) {
            front = std::max(front, a.z - (n.x * (x - a.x) + n.y * (y - a.y)) / n.z);
        }
    }
    return front;
}

struct FacePlaces {
    Vec3 eye;    ///< center of the left ball
    Vec3 mouth;  ///< in the middle of the lips, near the surface
    float unit;  ///< of the head's size to the reference
};

FacePlaces places_of(const PersonShape& shape) {
    const PersonFrame frame = measure_person(shape);
    const float unit = frame.scale * frame.head_scale;
    return {
        frame.scale * frame.at(PersonJoint::LeftEye),
        frame.scale * frame.head_origin + unit * Vec3(0, -0.0335f, 0.11f), unit};
}

/// Height of the gap between the lips: where the foremost surface is far behind them [m].
float mouth_gap(const MeshData& mesh, const FacePlaces& places) {
    constexpr float kStep = 0.0005f;
    float gap = 0;
    for (float dy = -0.025f; dy < 0.012f; dy += kStep) {
        const float z = front_at(mesh, 0.001f, places.mouth.y + dy * places.unit);
        gap += z < places.mouth.z - 0.0065f * places.unit ? kStep : 0.0f;
    }
    return gap;
}

}  // namespace

TEST_CASE(
    "person: the jaw shape opens the mouth, which is closed at rest"
    * technique("char.morph-target")) {
    for (const int seed : {1, 2, 3}) {
        CAPTURE(seed);
        const PersonShape shape = skin_of(seed);
        const FacePlaces places = places_of(shape);
        const MeshData rest = make_person(shape);
        CHECK(mouth_gap(rest, places) == 0);
        const float half = mouth_gap(with_shape(rest, "AU26", 0.5f), places);
        const float whole = mouth_gap(with_shape(rest, "AU26", 1), places);
        CHECK(whole > 0.010f);
        CHECK(whole < 0.035f);
        CHECK(half > 0.3f * whole);
        CHECK(half < 0.7f * whole);
    }
}

TEST_CASE("person: a blink draws the lids over the eyes, which are open at rest") {
    for (const int seed : {1, 2, 3}) {
        CAPTURE(seed);
        const PersonShape shape = skin_of(seed);
        const FacePlaces places = places_of(shape);
        const MeshData rest = make_person(shape);
        const MeshData shut = with_shape(rest, "AU45", 1);
        const float ball = places.eye.z + 0.0127f * places.unit;
        CHECK(front_at(rest, places.eye.x, places.eye.y) < ball - 0.004f * places.unit);
        for (const float dx : {-0.004f, 0.0f, 0.004f}) {
            for (const float dy : {-0.004f, -0.002f, 0.0f, 0.002f, 0.004f}) {
                CAPTURE(dx);
                CAPTURE(dy);
                const Vec2 from = places.unit * Vec2(dx, dy);
                const float eye =
                    places.eye.z + std::sqrt(square(0.0127f * places.unit) - glm::dot(from, from));
                CHECK(
                    front_at(shut, places.eye.x + from.x, places.eye.y + from.y)
                    > eye - 0.001f * places.unit);
            }
        }
    }
}

TEST_CASE("person: corners of a smiling or stretched mouth move out, those of a round one in") {
    const PersonShape shape = skin_of(1);
    const FacePlaces places = places_of(shape);
    const MeshData rest = make_person(shape);
    const auto corner = [&](std::string_view name) {
        const MorphTarget& target = shape_called(rest, name);
        Vec3 sum(0);
        for (std::size_t i = 0; i < target.vertices.size(); ++i) {
            const Vec3 from = rest.positions[target.vertices[i]] - places.mouth;
            const bool near_corner =
                glm::distance(from / places.unit, Vec3(0.025f, -0.001f, -0.009f)) < 0.008f;
            sum += near_corner ? target.positions[i] : Vec3(0);
        }
        return sum;
    };
    CHECK(corner("AU12").x > 0.004f);
    CHECK(corner("AU12").y > 0.004f);
    CHECK(corner("AU20").x > 0.004f);
    CHECK(corner("AU18").x < -0.004f);
}

TEST_CASE("person: seams of the skin do not tear when the face moves") {
    for (const int seed : {1, 2}) {
        const MeshData mesh = make_person(skin_of(seed));
        for (const MorphTarget& shape : mesh.morphs) {
            std::vector<Vec3> shifts(mesh.positions.size(), Vec3(0));
            for (std::size_t i = 0; i < shape.vertices.size(); ++i) {
                shifts[shape.vertices[i]] = shape.positions[i];
            }
            std::map<std::array<float, 3>, Vec3> places;
            float worst = 0;
            for (std::size_t v = 0; v < shifts.size(); ++v) {
                const Vec3& p = mesh.positions[v];
                const auto [found, added] = places.try_emplace({p.x, p.y, p.z}, shifts[v]);
                worst = std::max(worst, glm::distance(found->second, shifts[v]));
            }
            CAPTURE(shape.name);
            CHECK(worst < 1e-4f);
        }
    }
}

TEST_CASE(
    "person: shapes of the face are few and sparse, and only near levels of detail have them") {
    const MeshData full = make_person({.seed = 2});
    const MeshData close = make_person({.seed = 2, .head_triangles = 4000, .triangles = 9000});
    const MeshData far = make_person({.seed = 2, .triangles = 3600});
    CHECK(far.morphs.empty());
    REQUIRE(close.morphs.size() == kPersonFaceShapes);
    REQUIRE(full.morphs.size() >= kPersonFaceShapes);
    CHECK(open_edges(close) == 0);
    std::size_t entries = 0;
    for (std::size_t t = 0; t < kPersonFaceShapes; ++t) {
        const MorphTarget& shape = close.morphs[t];
        CHECK(shape.name == full.morphs[full.morphs.size() - kPersonFaceShapes + t].name);
        CHECK(shape.normals.size() == shape.vertices.size());
        CHECK(!shape.vertices.empty());
        entries += shape.vertices.size();
        for (const Vec3& shift : shape.positions) {
            CHECK(glm::length(shift) < 0.045f);
        }
    }
    CHECK(entries < 2 * close.positions.size());
}

TEST_CASE(
    "person: in the talk clip the mouth opens and closes, and is at rest at both ends"
    * technique("char.morph-anim")) {
    for (const int triangles : {0, 9000}) {
        const PersonShape shape = {.seed = 4, .triangles = triangles};
        const MeshRig rig = make_person_rig(shape);
        const MeshData mesh = make_person(shape);
        const auto talk = std::ranges::find(rig.clips, "talk", &ClipData::name);
        REQUIRE(talk != rig.clips.end());
        REQUIRE(check_clip(*talk, rig.skeleton.joints.size(), mesh.morphs.size()));
        const ClipSheet& sheet = talk->sheets.at(0);
        REQUIRE(mesh.morphs[sheet.morphing.at(0)].name == "AU26");
        float widest = 0;
        int closures = 0;
        bool open = false;
        for (std::size_t key = 0; key < sheet.times.size(); ++key) {
            const float jaw = sheet.weights[key * sheet.morphing.size()];
            widest = std::max(widest, jaw);
            closures += open && jaw < 0.06f ? 1 : 0;
            open = jaw > 0.06f && (open || jaw > 0.2f);
            for (std::size_t k = 0; k < sheet.morphing.size(); ++k) {
                const float weight = sheet.weights[key * sheet.morphing.size() + k];
                CHECK(weight >= 0);
                CHECK(weight <= 1);
            }
        }
        CHECK(widest > 0.4f);
        CHECK(closures >= 5);
        CHECK(std::abs(sheet.weights.front()) < 1e-3f);
        CHECK(std::abs(sheet.weights.back()) < 1e-3f);
    }
    const MeshRig far = make_person_rig({.triangles = 3600});
    CHECK(std::ranges::find(far.clips, "talk", &ClipData::name) == far.clips.end());
}

}  // namespace limn::person_face_test
