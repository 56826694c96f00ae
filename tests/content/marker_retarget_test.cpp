#include "content/load/faces/face_skin.h"
#include "content/load/faces/marker_retarget.h"
#include "content/make/head/head.h"
#include "content/make/head/head_expressions.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace limn::marker_retarget_test {
namespace {

using test::near;

const std::vector<std::string> kNames{"chin",       "LeftJaw",    "jaw_R",     "L_mouth",
                                      "mouth.R",    "UpperLip",   "lower lip", "nose",
                                      "BrowInnerL", "browInnerR", "CheekL",    "R-Cheek"};

const GltfScene& face() {
    static const GltfScene scene = [] {
        GltfScene head;
        head.name = "head.glb";
        head.meshes.push_back(make_head({}));
        return head;
    }();
    return scene;
}

FaceMarkers places(const std::vector<FaceMarkerPlace>& map = {}) {
    const Result<FaceMarkers> placed = place_markers(face(), kNames, map, "take.map");
    REQUIRE(placed);
    return *placed;
}

/// A take of these markers on a face of another size, that moves by `motion` of place and time.
MarkerMotion make_take(const auto& map, const auto& motion) {
    MarkerMotion take;
    take.names = kNames;
    for (int f = 0; f < 6; ++f) {
        for (const Vec3& p : places().points) {
            take.positions.push_back(map(p + 0.2f * static_cast<float>(f) * motion(p)));
        }
    }
    return take;
}

Vec3 open_jaw(const Vec3& p) {
    return Vec3(0, p.y < -0.035f ? -0.02f : 0.0f, 0);
}

}  // namespace

TEST_CASE(
    "marker retarget: common names have their place, mirrored from side to side"
    * technique("face.retarget-fit")) {
    const FaceMarkers found = places();
    CHECK(found.points[0].y < found.points[6].y);          // the chin below the lower lip
    CHECK(found.points[6].y < found.points[5].y + 1e-3f);  // below the upper
    CHECK(found.points[7].z > found.points[5].z);          // the nose in front
    for (const auto& [left, right] :
         std::vector<std::pair<std::size_t, std::size_t>>{{1, 2}, {3, 4}, {8, 9}, {10, 11}}) {
        CHECK(found.points[left].x > 0.005f);
        CHECK(glm::distance(found.points[left] * Vec3(-1, 1, 1), found.points[right]) < 1e-3f);
    }
}

TEST_CASE(
    "marker retarget: the rest is at rest, and a similar face moves alike, by its size"
    * technique("face.retarget-warp")) {
    const Affine map =
        affine_from({0.3f, 1.2f, -0.4f}, glm::normalize(Quat(0.9f, 0.1f, 0.3f, -0.2f)), Vec3(1.7f));
    const MarkerMotion take =
        make_take([&](const Vec3& p) { return transform_point(map, p); }, open_jaw);
    const FaceMarkers found = places();
    const MarkerMotion moved = retarget_markers(take, found.points);
    for (std::size_t i = 0; i < moved.positions.size(); ++i) {
        const Vec3 rest = found.points[i % kNames.size()];
        const float frame = static_cast<float>(i / kNames.size());
        CHECK(glm::distance(moved.positions[i], rest + 0.2f * frame * open_jaw(rest)) < 2e-5f);
    }
    // Three markers determine no warp: offsets are scaled by the size of the face.
    MarkerMotion three;
    three.names = {"a", "b", "c"};
    three.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 0}, {2, 1, 0}, {0, 2, 0}};
    const std::vector<Vec3> half = {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
    CHECK(glm::distance(retarget_markers(three, half).positions[4], Vec3(6, 0.5f, 0)) < 1e-6f);
}

TEST_CASE(
    "marker retarget: shapes follow the markers: weights of the face's own shapes are found again"
    * technique("face.retarget-warp")) {
    const FaceMarkers found = places();
    for (const char* const unit : {"AU26", "AU27", "AU12_L"}) {
        const std::size_t shape = expression_index(unit);
        std::vector<Vec3> offsets(found.points.size());
        for (std::size_t m = 0; m < offsets.size(); ++m) {
            offsets[m] = 0.7f * found.moves[shape][m];
        }
        std::vector<float> weights(found.shapes.size(), 0.0f);
        fit_shape_weights(found, offsets, weights);
        double left = 0;
        double all = 0;
        for (std::size_t m = 0; m < offsets.size(); ++m) {
            Vec3 sum(0);
            for (std::size_t s = 0; s < weights.size(); ++s) {
                CHECK(weights[s] >= 0.0f);
                CHECK(weights[s] <= 1.0f);
                sum += weights[s] * found.moves[s][m];
            }
            left += glm::dot(sum - offsets[m], sum - offsets[m]);
            all += glm::dot(offsets[m], offsets[m]);
        }
        CHECK(left < 0.15 * all);
    }
    // Brows alone follow as far as a jaw does, though they move much less.
    for (const char* const unit : {"AU1_L", "AU1_R", "AU4_L"}) {
        const std::size_t shape = expression_index(unit);
        std::vector<Vec3> offsets = found.moves[shape];
        std::vector<float> weights(found.shapes.size(), 0.0f);
        fit_shape_weights(found, offsets, weights);
        double along = 0;
        double all = 0;
        for (std::size_t m = 0; m < offsets.size(); ++m) {
            Vec3 sum(0);
            for (std::size_t s = 0; s < weights.size(); ++s) {
                sum += weights[s] * found.moves[s][m];
            }
            along += glm::dot(sum, offsets[m]);
            all += glm::dot(offsets[m], offsets[m]);
        }
        CAPTURE(unit);
        CHECK(along / all > 0.95);
        CHECK(along / all < 1.02);
    }
    std::vector<float> none(found.shapes.size(), 0.5f);
    fit_shape_weights(found, std::vector<Vec3>(found.points.size(), Vec3(0)), none);
    for (const float weight : none) {
        CHECK(weight < 0.02f);
    }
}

TEST_CASE(
    "marker retarget: a map places markers by points and names, and lists what is wrong"
    * technique("face.retarget-fit")) {
    const auto map = parse_marker_map(
        "\xef\xbb\xbf# take of June\nchin = 0 -0.07 0.1  # on the tip\nnose = mouth9_90_M\n\n",
        "take.map");
    REQUIRE(map);
    REQUIRE(map->size() == 2);
    const FaceMarkers found = places(*map);
    CHECK(glm::distance(found.points[0], Vec3(0, -0.07f, 0.1f)) < 0.01f);
    // Between vertices, points stay where they are, and move by shares of their motion.
    const MeshData& skin = face().meshes[0];
    const std::size_t shape = expression_index("AU26");
    std::vector<Vec3> jaw(skin.positions.size(), Vec3(0));
    for (std::size_t i = 0; i < skin.morphs[shape].vertices.size(); ++i) {
        jaw[skin.morphs[shape].vertices[i]] = skin.morphs[shape].positions[i];
    }
    for (const std::size_t triangle : {600U, 2401U, 5000U}) {
        SkinPoint between{{}, {0.5f, 0.3f, 0.2f}};
        for (std::size_t k = 0; k < 3; ++k) {
            between.vertices[k] = skin.indices[3 * triangle + k];
        }
        const Vec3 at = position_on(between, skin.positions);
        const FaceMarkers there = places({{"chin", "", at, 1}});
        CHECK(glm::distance(there.points[0], at) < 1e-6f);
        CHECK(glm::distance(there.moves[shape][0], position_on(between, jaw)) < 1e-6f);
    }
    CHECK(glm::distance(found.points[7], found.points[5]) < 1e-3f);

    const auto parse_error = [](const char* text) {
        const auto result = parse_marker_map(text, "take.map");
        return result ? std::string("none") : result.error().message;
    };
    CHECK(parse_error("chin\n").starts_with("take.map:1: found \"chin\", expected \"marker = x"));
    CHECK(parse_error("\nchin = 1 2\n").starts_with("take.map:2: found \"1 2\", expected three"));
    const auto error = [](const std::vector<std::string>& names, const char* text) {
        const auto result =
            place_markers(face(), names, *parse_marker_map(text, "take.map"), "take.map");
        return result ? std::string("none") : result.error().message;
    };
    CHECK(
        error(kNames, "chim = chin\n").find("no markers \"chim\" (did you mean chin?)")
        != std::string::npos);
    const std::string two = error({"chin", "lowerlipp", "xyz"}, "");
    CHECK(two.find("\"lowerlipp\" (did you mean lowerlip?)") != std::string::npos);
    CHECK(two.find("\"xyz\"") != std::string::npos);
    CHECK(error({"chekL"}, "").find("\"chekL\" (did you mean cheekL?)") != std::string::npos);
    CHECK(error({"chin"}, "chin = mouth9_91_M\n").find("mouth9_90_M") != std::string::npos);
}

}  // namespace limn::marker_retarget_test
