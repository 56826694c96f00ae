#include "bench/oracles/face_folding.h"

#include "content/load/faces/action_unit_names.h"
#include "systems/faces/skin_strain.h"
#include "systems/faces/wrinkle_measure.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace limn::oracle {

namespace {

constexpr float kMidline = 1e-5f;  ///< |x| of vertices on the midline of a face [m]

const FoldingRule kRules[] = {
    {"brow raise",
     {"AU1", "AU2"},
     {"forehead"},
     {"cheek", "nasolabial", "upper_lip", "mouth_corner", "mentolabial"}},
    {"frown",
     {"AU4"},
     {"glabella", "nose_root"},
     {"cheek", "nasolabial", "upper_lip", "mentolabial"}},
    {"smile", {"AU12"}, {"nasolabial"}, {"forehead", "glabella", "nose_root", "upper_lid"}},
    {"smile with the cheeks", {"AU6", "AU12"}, {"crows_feet"}, {"forehead", "glabella"}},
    {"squint",
     {"AU7"},
     {"crows_feet", "lower_lid"},
     {"forehead", "glabella", "nasolabial", "upper_lip"}},
    {"squint beside the nose",
     {"AU7"},
     {"inner_canthus"},
     {"forehead", "glabella", "nose_root", "nasolabial", "upper_lip"}},
    {"nose sneer", {"AU9"}, {"nose_side"}, {"mentolabial"}},
    {"lip pucker", {"AU18"}, {"upper_lip"}, {"forehead", "glabella", "nose_root", "crows_feet"}},
    {"lip corners down",
     {"AU15"},
     {"marionette"},
     {"forehead", "glabella", "nose_root", "nose_side", "crows_feet", "lower_lid", "upper_lip"}},
    // Mentalis lifts the pad of the chin against the lower lip: the furrow between them and the
    // skin below the corners shorten first, in a direction; the pad itself dimples, in none.
    {"chin raise",
     {"AU17"},
     {"mentolabial", "marionette", "chin"},
     {"forehead", "glabella", "nose_root", "nose_side", "crows_feet", "nasolabial", "upper_lip"}},
    {"chin dimples",
     {"AU17"},
     {"chin"},
     {"forehead", "glabella", "nose_root", "nose_side", "crows_feet", "nasolabial", "upper_lip"},
     true},
};

/// "AU12" of "AU12_L".
std::string without_side(std::string_view name) {
    const bool has_side = name.ends_with("_L") || name.ends_with("_R");
    return std::string(name.substr(0, name.size() - (has_side ? 2 : 0)));
}

/// "mouthSmile" of "mouthSmile_L" and "mouthSmileLeft".
std::string common_name(std::string_view name) {
    for (const std::string_view suffix : {"Left", "Right"}) {
        if (name.ends_with(suffix)) {
            return std::string(name.substr(0, name.size() - suffix.size()));
        }
    }
    return without_side(name);
}

}  // namespace

struct FaceFolding::Region {
    WrinkleRest rest;
    SkinTriangles skin;
    std::vector<double> area;           ///< per vertex: its area times its weight
    std::vector<double> triangle_area;  ///< per triangle of the skin, likewise
    std::vector<Vec3> skin_across;
};

std::vector<FaceExpression> find_face_expressions(const MeshData& mesh) {
    std::vector<FaceExpression> found;
    for (std::uint32_t i = 0; i < mesh.morphs.size(); ++i) {
        const MorphTarget& morph = mesh.morphs[i];
        const std::string unit =
            !morph.action_unit.empty() ? morph.action_unit : find_action_unit(morph.name);
        const bool halved = unit != without_side(unit);
        const auto same = std::ranges::find_if(found, [&](const FaceExpression& other) {
            return halved && other.unit == without_side(unit);
        });
        if (same != found.end()) {
            same->morphs.push_back(i);
        } else {
            found.push_back(
                {halved ? common_name(morph.name) : morph.name, without_side(unit), {i}});
        }
    }
    return found;
}

FaceFolding::FaceFolding(const MeshData& mesh) : mesh_(mesh) {
    const auto mean_of = [](const std::vector<float>& values, const std::uint32_t* v) {
        return double{values[v[0]] + values[v[1]] + values[v[2]]} / 3;
    };
    const SkinTriangles skin = make_skin_triangles(mesh.positions, mesh.indices, 0);
    for (const VertexRegion& source : mesh.regions) {
        Region& region = regions_.emplace_back();
        const std::size_t vertices = mesh.positions.size();
        const bool any_direction = source.across.empty();
        if (!any_direction && source.across.size() != vertices) {
            continue;
        }
        const std::vector<Vec3> across =
            any_direction ? std::vector<Vec3>(vertices, Vec3(0)) : source.across;
        const std::vector<float> aside(vertices, any_direction ? 0.5f : 0.0f);
        region.rest = make_wrinkle_rest(
            mesh.positions, mesh.indices, across, WrinkleWeight::Angle,
            {.aside = aside, .narrowing = 0});
        region.area.assign(mesh.positions.size(), 0.0);
        for (std::size_t t = 0; t + 3 <= region.rest.corners.size(); t += 3) {
            const std::uint32_t* const v = &region.rest.corners[t];
            const Vec3& p = mesh.positions[v[0]];
            const Vec3 cross = glm::cross(mesh.positions[v[1]] - p, mesh.positions[v[2]] - p);
            for (std::size_t k = 0; k < 3; ++k) {
                region.area[v[k]] += double{glm::length(cross)} * double{source.weights[v[k]]};
            }
        }
        region.skin = skin;
        for (std::size_t t = 0; t < skin.area.size(); ++t) {
            const std::uint32_t* const v = &skin.corners[3 * t];
            region.triangle_area.push_back(double{skin.area[t]} * mean_of(source.weights, v));
            region.skin_across.push_back(across[v[0]]);
        }
    }
}

FaceFolding::~FaceFolding() = default;

std::vector<RegionFolding>
FaceFolding::measure(std::span<const std::uint32_t> morphs, float weight) const {
    std::vector<Vec3> deformed = mesh_.positions;
    for (const std::uint32_t m : morphs) {
        const MorphTarget& morph = mesh_.morphs[m];
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            deformed[morph.vertices[i]] += weight * morph.positions[i];
        }
    }
    std::vector<RegionFolding> found;
    std::vector<SkinStrain> strain;
    for (const Region& region : regions_) {
        RegionFolding& folding = found.emplace_back();
        if (region.area.empty()) {
            continue;  // without directions
        }
        const std::vector<float> ratio = vertex_compression({&region.rest, 1}, deformed);
        double sums[2] = {};
        double areas[2] = {};
        for (std::size_t v = 0; v < ratio.size(); ++v) {
            const float x = mesh_.positions[v].x;
            // Vertices on the midline count half for each side.
            const double left = x > kMidline ? 1 : x < -kMidline ? 0 : 0.5;
            const double shortening = std::max(1 - std::sqrt(double{ratio[v]}), 0.0);
            sums[0] += left * region.area[v] * shortening;
            sums[1] += (1 - left) * region.area[v] * shortening;
            areas[0] += left * region.area[v];
            areas[1] += (1 - left) * region.area[v];
        }
        const double total = areas[0] + areas[1];
        folding.shortening = total > 0 ? (sums[0] + sums[1]) / total : 0;
        folding.left = areas[0] > 0 ? sums[0] / areas[0] : 0;
        folding.right = areas[1] > 0 ? sums[1] / areas[1] : 0;
        if (strain.empty()) {
            strain.resize(region.skin.area.size());
            find_strain(region.skin, deformed, strain);
        }
        double turns = 0;
        double weights = 0;
        for (std::size_t t = 0; t < strain.size(); ++t) {
            const PrincipalStrain p = principal_strain(strain[t]);
            const Vec3 direction =
                std::cos(p.angle) * region.skin.u[t] + std::sin(p.angle) * region.skin.v[t];
            const float length = glm::length(region.skin_across[t]);
            if (region.triangle_area[t] > 0 && p.lower < 0 && length > 0.5f) {
                const double amount = region.triangle_area[t] * double{-p.lower};
                const float cosine = std::abs(glm::dot(direction, region.skin_across[t])) / length;
                turns += amount * double{std::acos(std::min(cosine, 1.0f))};
                weights += amount;
            }
        }
        folding.turn = weights > 0 ? turns / weights : 0;
    }
    return found;
}

std::span<const FoldingRule> folding_rules() {
    return kRules;
}

bool apply_rule(
    const FoldingRule& rule, const MeshData& mesh, const FaceFolding& folding,
    FoldingResult& result) {
    const std::vector<FaceExpression> expressions = find_face_expressions(mesh);
    std::vector<std::uint32_t> morphs;
    for (const std::string_view unit : rule.units) {
        const auto found = std::ranges::find(expressions, unit, &FaceExpression::unit);
        if (found == expressions.end()) {
            return false;
        }
        morphs.insert(morphs.end(), found->morphs.begin(), found->morphs.end());
    }
    const std::vector<RegionFolding> measured = folding.measure(morphs);
    result = {};
    bool found_region = false;
    for (std::size_t i = 0; i < measured.size(); ++i) {
        const std::string_view name = mesh.regions[i].name;
        const RegionFolding& m = measured[i];
        if (std::ranges::find(rule.folds, name) != rule.folds.end()) {
            found_region = true;
            const double larger = std::max(m.left, m.right);
            if (m.shortening > result.folding) {
                result.folding = m.shortening;
                result.difference = std::abs(m.left - m.right) / larger;
            }
        }
        if (std::ranges::find(rule.smooth, name) != rule.smooth.end()) {
            result.smooth = std::max(result.smooth, m.shortening);
        }
    }
    return found_region;
}

}  // namespace limn::oracle
