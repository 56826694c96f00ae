#include "content/make/head/head.h"
#include "content/make/head/head_correctives.h"
#include "content/make/head/head_expressions.h"
#include "content/make/head/head_layout.h"
#include "content/make/head/head_surface.h"
#include "content/make/head/head_wrap.h"
#include "systems/animation/driven_shapes_system.h"
#include "tests/content/head_skin.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace limn::head_correctives_test {
namespace {

const std::vector<HeadPoint>& skin() {
    return test::head_skin();
}

const std::vector<MorphTarget>& shapes() {
    return test::head_shapes();
}

using Weights = std::vector<std::pair<std::string, float>>;

/// Positions of the skin [cm], with or without the shapes that the units drive.
std::vector<Vec3> posed(const Weights& units, bool follows) {
    std::vector<float> weights(shapes().size(), 0.0f);
    for (const auto& unit : units) {
        weights[expression_index(unit.first)] = unit.second;
    }
    std::vector<Vec3> positions;
    for (const HeadPoint& point : skin()) {
        positions.push_back(point.rest);
    }
    for (std::size_t t = 0; t < shapes().size(); ++t) {
        const MorphTarget& target = shapes()[t];
        const float weight = target.drivers.empty() ? weights[t]
                             : follows              ? driven_weight(target.drivers, weights)
                                                    : 0.0f;
        for (std::size_t i = 0; weight != 0 && i < target.vertices.size(); ++i) {
            positions[target.vertices[i]] += 100.0f * weight * target.positions[i];
        }
    }
    return positions;
}

/// Smallest and largest opening of the left eye between its corners; negative where lids cross
/// [cm].
std::pair<float, float> opening(const Weights& units, bool follows) {
    const std::vector<Vec3> positions = posed(units, follows);
    std::vector<std::pair<float, float>> edge;  // of the angle, and of y
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const HeadPoint& point = skin()[v];
        if (point.loops == HeadLoops::Eye && point.loop == kLidLoop && point.rest.x > 0) {
            edge.emplace_back(point.angle, positions[v].y);
        }
    }
    std::ranges::sort(edge);
    REQUIRE(edge.size() > 20);
    std::pair<float, float> range = {100, -100};
    for (std::size_t k = 1; k < edge.size() / 2; ++k) {
        const float upper = std::sin(edge[k].first) > 0 ? 1.0f : -1.0f;
        const float gap = upper * (edge[k].second - edge[edge.size() - k].second);
        range = {std::min(range.first, gap), std::max(range.second, gap)};
    }
    return range;
}

}  // namespace

TEST_CASE("head correctives: they come last and follow a unit, or two on one side") {
    const std::size_t own = expression_names().size();
    REQUIRE(shapes().size() > own);
    for (std::size_t t = 0; t < shapes().size(); ++t) {
        CAPTURE(shapes()[t].name);
        CHECK(shapes()[t].drivers.empty() == (t < own));
        std::string name;
        for (const ShapeDriver& driver : shapes()[t].drivers) {
            CHECK(driver.target < own);
            CHECK(driver.peak == (shapes()[t].drivers.size() == 1 ? 0.5f : 1.0f));
            name += (name.empty() ? "" : "_") + shapes()[driver.target].name;
        }
        if (t >= own) {
            CHECK(shapes()[t].name == name + (shapes()[t].drivers.size() == 1 ? "_half" : ""));
            CHECK(shapes()[t].action_unit.empty());
        }
    }
}

TEST_CASE("head correctives: while the jaw opens the chin keeps its distance from the joint") {
    const auto chin = static_cast<std::size_t>(
        std::ranges::min_element(
            skin(), {},
            [](const HeadPoint& p) { return glm::distance(p.rest, Vec3(0, -7.5f, 10)); })
        - skin().begin());
    const auto distance = [&](float weight, bool follows) {
        const Vec3 p = posed({{"AU27", weight}}, follows)[chin];
        return glm::length(Vec2(p.y, p.z) - kJawAxis);
    };
    const float rest = distance(0, true);
    CHECK(std::abs(distance(0.5f, true) - rest) < 0.002f);  // [cm]
    CHECK(std::abs(distance(0.5f, false) - rest) > 0.05f);
    for (const float weight : {0.25f, 0.75f}) {
        const float bent = std::abs(distance(weight, true) - rest);
        CHECK(bent < 0.45f * std::abs(distance(weight, false) - rest));
    }
}

TEST_CASE("head correctives: an eye that two units close is closed once") {
    for (const char* const closer : {"AU43", "AU45"}) {
        for (const char* const other : {"AU6", "AU7", "AU42", "AU44", "AU45", "AU64"}) {
            if (std::string(closer) == other) {
                continue;
            }
            CAPTURE(closer);
            CAPTURE(other);
            const Weights both = {{std::string(closer) + "_L", 1}, {std::string(other) + "_L", 1}};
            const auto gap = opening(both, true);
            CHECK(gap.first > -0.03f);  // [cm]
            CHECK(gap.second < 0.03f);
        }
    }
    CHECK(opening({{"AU43_L", 1}, {"AU44_L", 1}}, false).first < -0.3f);
}

}  // namespace limn::head_correctives_test
