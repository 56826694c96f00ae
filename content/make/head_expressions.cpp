#include "content/make/head_expressions.h"

#include "content/make/head_visemes.h"
#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <algorithm>
#include <string>
#include <utility>

namespace limn {

namespace {

constexpr float kMeters = 0.01f;     ///< per centimeter
constexpr float kMinOffset = 2e-5f;  ///< [cm]: a fifth of a micrometer is no movement
enum class Side : std::uint8_t { Both, Left, Right };

struct Expression {
    std::string name;
    const ActionUnit* unit = nullptr;
    const HeadViseme* viseme = nullptr;
    Side side = Side::Both;
};

const std::vector<Expression>& expressions() {
    static const std::vector<Expression> list = [] {
        std::vector<Expression> made;
        for (const ActionUnit& unit : action_units()) {
            const std::string name(unit.name);
            if (unit.sided) {
                made.push_back({name + "_L", &unit, nullptr, Side::Left});
                made.push_back({name + "_R", &unit, nullptr, Side::Right});
            } else {
                made.push_back({name, &unit, nullptr, Side::Both});
            }
        }
        for (const HeadViseme& viseme : head_visemes()) {
            made.push_back({std::string(viseme.name), nullptr, &viseme, Side::Both});
        }
        return made;
    }();
    return list;
}

Vec3 offset_of(const Expression& expression, const HeadPoint& point, const HeadShape& shape) {
    if (expression.viseme != nullptr) {
        return viseme_offset(*expression.viseme, point, shape);
    }
    const float left = left_share(point.rest.x);
    const float share = expression.side == Side::Both   ? 1
                        : expression.side == Side::Left ? left
                                                        : 1 - left;
    return share > 0 ? share * action_offset(*expression.unit, point, shape) : Vec3(0);
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
            for (std::uint32_t v = 0; v < points.size(); ++v) {
                const Vec3 offset = offset_of(expression, points[v], shape);
                if (glm::dot(offset, offset) > square(kMinOffset)) {
                    target.vertices.push_back(v);
                    target.positions.push_back(kMeters * offset);
                }
            }
        }
    });
    return targets;
}

std::vector<std::string> expression_names() {
    std::vector<std::string> names;
    for (const Expression& expression : expressions()) {
        names.push_back(expression.name);
    }
    return names;
}

std::uint16_t expression_index(std::string_view name) {
    const auto found = std::ranges::find(expressions(), name, &Expression::name);
    LIMN_CHECK(found != expressions().end());
    return static_cast<std::uint16_t>(found - expressions().begin());
}

}  // namespace limn
