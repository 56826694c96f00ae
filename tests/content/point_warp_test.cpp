#include "content/bake/point_warp.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <vector>

namespace limn::point_warp_test {
namespace {

const std::vector<Vec3> kFrom = {{0, 0, 0}, {1, 0, 0},    {0, 1, 0},         {0, 0, 1},
                                 {1, 1, 1}, {2, 1, 0.5f}, {0.3f, 0.2f, 1.7f}};

}  // namespace

TEST_CASE("point warp: it interpolates the given points" * technique("face.retarget-fit")) {
    const std::vector<Vec3> to = {{0, 0.1f, 0}, {1.2f, 0, 0}, {0, 1, 0.3f},      {0, 0, 1.5f},
                                  {1, 2, 1},    {2, 1, 0},    {0.5f, 0.2f, 1.7f}};
    const Result<PointWarp> warp = make_point_warp(kFrom, to);
    REQUIRE(warp.ok());
    for (std::size_t i = 0; i < to.size(); ++i) {
        CHECK(glm::distance(warp_point(*warp, kFrom[i]), to[i]) < 1e-5f);
    }
}

TEST_CASE("point warp: an affine map is reproduced everywhere" * technique("face.retarget-fit")) {
    const auto map = [](const Vec3& p) {
        return Vec3(2 * p.x + 0.5f * p.y + 1, p.y - 3 * p.z, 0.1f * p.x + p.z - 2);
    };
    std::vector<Vec3> to;
    for (const Vec3& p : kFrom) {
        to.push_back(map(p));
    }
    const PointWarp warp = *make_point_warp(kFrom, to);
    for (const Vec3& p : std::vector<Vec3>{{5, -3, 2}, {0.4f, 0.4f, 0.4f}, {-10, 20, 7}}) {
        CHECK(glm::distance(warp_point(warp, p), map(p)) < 2e-4f);
    }
}

TEST_CASE("point warp: points that coincide, or are coplanar, are rejected") {
    const auto message = [](const std::vector<Vec3>& points) {
        const Result<PointWarp> warp = make_point_warp(points, points);
        return warp ? "it is made" : warp.error().message;
    };
    CHECK(
        message({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})
        == "found 3 points to warp by, expected at least 4");
    const char* const degenerate = "found points to warp by that coincide or lie in one plane";
    CHECK(message({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 3, 0}}) == degenerate);
    std::vector<Vec3> twice = kFrom;
    twice.push_back(kFrom[2]);
    CHECK(message(twice) == degenerate);
    CHECK(message(kFrom) == "it is made");
}

}  // namespace limn::point_warp_test
