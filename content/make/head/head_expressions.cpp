#include "content/make/head/head_expressions.h"

#include "content/make/head/head_correctives.h"
#include "content/make/head/head_visemes.h"
#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Techniques: wrinkle.compression.face-model

namespace limn {

namespace {

constexpr float kExpressionMeters = 0.01f;  ///< per centimeter
constexpr float kMinOffset =
    2e-5f;  ///< [cm]; less than a fifth of a micrometer counts as no movement
enum class FaceSide : std::uint8_t { Both, Left, Right };

/// A unit, a viseme or a corrective.
struct Expression {
    std::string name;
    const ActionUnit* unit = nullptr;
    const HeadViseme* viseme = nullptr;
    const HeadCorrective* corrective = nullptr;
    FaceSide side = FaceSide::Both;
};

/// Name of `unit` on `side`.
std::string sided_name(std::string_view unit, FaceSide side) {
    const char* const end = side == FaceSide::Left ? "_L" : side == FaceSide::Right ? "_R" : "";
    return std::string(unit) + end;
}

/// Name in the list, as "AU43_L".
std::string driver_name(std::string_view unit, FaceSide side) {
    return sided_name(unit, action_unit(unit).sided ? side : FaceSide::Both);
}

std::string name_of(const HeadCorrective& corrective, FaceSide side) {
    return driver_name(corrective.unit, side) + "_"
           + (corrective.other.empty() ? "half" : driver_name(corrective.other, side));
}

std::span<const FaceSide> sides_of(const ActionUnit& unit) {
    static constexpr FaceSide kSides[] = {FaceSide::Both, FaceSide::Left, FaceSide::Right};
    return unit.sided ? std::span(kSides).subspan(1) : std::span(kSides).first(1);
}

const std::vector<Expression>& expressions() {
    static const std::vector<Expression> list = [] {
        std::vector<Expression> made;
        for (const ActionUnit& unit : action_units()) {
            for (const FaceSide side : sides_of(unit)) {
                made.push_back({sided_name(unit.name, side), &unit, nullptr, nullptr, side});
            }
        }
        for (const HeadViseme& viseme : head_visemes()) {
            made.push_back({std::string(viseme.name), nullptr, &viseme, nullptr, FaceSide::Both});
        }
        for (const HeadCorrective& corrective : head_correctives()) {
            for (const FaceSide side : sides_of(action_unit(corrective.unit))) {
                made.push_back({name_of(corrective, side), nullptr, nullptr, &corrective, side});
            }
        }
        return made;
    }();
    return list;
}

Vec3 offset_of(const Expression& expression, const HeadPoint& point, const HeadShape& shape) {
    if (expression.viseme != nullptr) {
        return viseme_offset(*expression.viseme, point, shape);
    }
    const float left = left_weight(point.rest.x);
    const float weight = expression.side == FaceSide::Both   ? 1
                         : expression.side == FaceSide::Left ? left
                                                             : 1 - left;
    if (weight <= 0) {
        return Vec3(0);
    }
    return weight
           * (expression.unit != nullptr ? action_offset(*expression.unit, point, shape)
                                         : corrective_offset(*expression.corrective, point, shape));
}

std::vector<ShapeDriver> drivers_of(const Expression& expression) {
    if (expression.corrective == nullptr) {
        return {};
    }
    const HeadCorrective& corrective = *expression.corrective;
    const std::uint16_t unit = expression_index(driver_name(corrective.unit, expression.side));
    if (corrective.other.empty()) {
        return {{unit, 0.5f}};
    }
    return {{unit, 1}, {expression_index(driver_name(corrective.other, expression.side)), 1}};
}

}  // namespace

std::vector<MorphTarget>
make_expressions(std::span<const HeadPoint> points, const HeadShape& shape) {
    std::vector<MorphTarget> targets(expressions().size());
    parallel_for(targets.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Expression& expression = expressions()[i];
            MorphTarget& target = targets[i];
            target.name = expression.name;
            target.action_unit = expression.unit != nullptr ? expression.name : std::string();
            target.drivers = drivers_of(expression);
            for (std::uint32_t v = 0; v < points.size(); ++v) {
                const Vec3 offset = offset_of(expression, points[v], shape);
                if (glm::dot(offset, offset) > square(kMinOffset)) {
                    target.vertices.push_back(v);
                    target.positions.push_back(kExpressionMeters * offset);
                }
            }
        }
    });
    return targets;
}

std::vector<std::string> expression_names() {
    std::vector<std::string> names;
    for (const Expression& expression : expressions()) {
        if (expression.corrective == nullptr) {
            names.push_back(expression.name);
        }
    }
    return names;
}

std::uint16_t expression_count() {
    return static_cast<std::uint16_t>(expressions().size());
}

std::uint16_t expression_index(std::string_view name) {
    const auto found = std::ranges::find(expressions(), name, &Expression::name);
    LIMN_CHECK(found != expressions().end());
    return static_cast<std::uint16_t>(found - expressions().begin());
}

}  // namespace limn
