#include "content/bake/detail_bake.h"

#include "content/bake/chart_samples.h"
#include "content/bake/occlusion_bake.h"
#include "ecs/base/check.h"
#include "ecs/base/jobs.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <tuple>

// Techniques: bump.nm-detail-recovery

namespace limn {

namespace {

/// Sums of the normals of all vertices at a position, unit.
std::vector<Vec3> cage_normals(const MeshData& mesh) {
    std::map<std::tuple<float, float, float>, Vec3> sums;
    const auto key = [&](std::size_t v) {
        const Vec3& p = mesh.positions[v];
        return std::tuple(p.x, p.y, p.z);
    };
    // A NaN would break the order of the map.
    const auto usable = [&](std::size_t v) {
        return is_finite(mesh.positions[v]) && is_finite(mesh.normals[v]);
    };
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (usable(v)) {
            sums.try_emplace(key(v), Vec3(0)).first->second += mesh.normals[v];
        }
    }
    std::vector<Vec3> normals(mesh.positions.size(), Vec3(0, 0, 1));
    for (std::size_t v = 0; v < normals.size(); ++v) {
        if (usable(v)) {
            normals[v] = normalize_or(sums.at(key(v)), mesh.normals[v]);
        }
    }
    return normals;
}

/// What a sample sees of the high mesh.
struct DetailSample {
    Vec3 normal = Vec3(0);
    float height = 0;  ///< along the cage normal [m]
    Vec3 position = Vec3(0);
    bool found = false;
    bool from_point = false;
};

struct DetailBaker {
    const MeshData& low;
    const MeshData& high;
    const DetailSettings& settings;
    RayCaster caster;
    std::vector<Vec3> cage;
    Charts charts;
    float distance;  ///< [m]
    float reach;     ///< of occlusion [m]
    std::vector<Vec3> sky;

    [[nodiscard]] Vec3 high_normal(const RayHit& hit) const {
        const std::span<const std::uint32_t> indices = high.indices;
        const std::size_t first = std::size_t{3} * hit.triangle;
        const Vec3& a = high.positions[indices[first]];
        const Vec3 face = glm::cross(
            high.positions[indices[first + 1]] - a, high.positions[indices[first + 2]] - a);
        const Vec3 flat = normalize_or(face, Vec3(0, 0, 1));
        return high.normals.empty() ? flat
                                    : normalize_or(at_hit<Vec3>(hit, indices, high.normals), flat);
    }

    /// `hits`: to reuse its memory.
    [[nodiscard]] DetailSample
    look(const Vec3& point, const Vec3& direction, std::vector<RayHit>& hits) const {
        caster.find_all(
            {.origin = point + distance * direction,
             .direction = -direction,
             .max_t = 2 * distance},
            hits);
        const auto distance_to = [this](const RayHit& hit) { return std::abs(hit.t - distance); };
        const RayHit* best = nullptr;
        for (const RayHit& hit : hits) {
            const bool better =
                best == nullptr || (hit.front && !best->front)
                || (hit.front == best->front && distance_to(hit) < distance_to(*best));
            best = better ? &hit : best;
        }
        DetailSample sample;
        if (best != nullptr) {
            sample.found = true;
            sample.height = distance - best->t;
            sample.position = point + sample.height * direction;
            const Vec3 normal = high_normal(*best);
            sample.normal = best->front ? normal : -normal;
            return sample;
        }
        if (const std::optional<RayHit> hit = caster.nearest_point(point, distance)) {
            sample.found = true;
            sample.from_point = true;
            sample.position = at_hit<Vec3>(*hit, high.indices, high.positions);
            sample.normal = high_normal(*hit);
            sample.height = glm::dot(sample.position - point, direction);
        }
        return sample;
    }

    [[nodiscard]] float open_sky(const Vec3& point, const Vec3& normal, std::uint32_t seed) const {
        const Vec3 origin = point + 1e-3f * reach * normal;
        int open = 0;
        for (const Vec3& direction : sky) {
            open += caster.nearest(
                        {.origin = origin,
                         .direction = turn_to(direction, normal, seed),
                         .max_t = reach})
                        ? 0
                        : 1;
        }
        return static_cast<float>(open) / static_cast<float>(sky.size());
    }
};

template <typename T>
T at_sample(const MeshData& mesh, const ChartSample& sample, const std::vector<T>& values) {
    const std::size_t first = std::size_t{3} * static_cast<std::size_t>(sample.triangle);
    return sample.weights.x * values[mesh.indices[first]]
           + sample.weights.y * values[mesh.indices[first + 1]]
           + sample.weights.z * values[mesh.indices[first + 2]];
}

DetailReport& operator+=(DetailReport& a, const DetailReport& b) {
    a.covered += b.covered;
    a.missed += b.missed;
    a.from_point += b.from_point;
    a.overlapping += b.overlapping;
    return a;
}

/// Bakes the row `y` from its samples; sets `covered`.
DetailReport bake_row(
    const DetailBaker& baker, int y, std::span<const ChartSample> samples, DetailBake& bake,
    std::vector<std::uint8_t>& covered) {
    const DetailSettings& settings = baker.settings;
    const int n = settings.samples;
    const auto columns = static_cast<std::size_t>(n) * static_cast<std::size_t>(settings.width);
    DetailReport report;
    std::vector<RayHit> hits;
    for (int x = 0; x < settings.width; ++x) {
        Vec3 normal(0);
        float height = 0;
        float occlusion = 0;
        int count = 0;
        int found = 0;
        const std::size_t texel = bake.normal.at(x, y);
        for (int k = 0; k < n * n; ++k) {
            const ChartSample& sample = samples
                [static_cast<std::size_t>(k / n) * columns
                 + static_cast<std::size_t>(x * n + k % n)];
            if (sample.triangle < 0) {
                continue;
            }
            ++count;
            const Vec3 point = at_sample(baker.low, sample, baker.low.positions);
            const Vec3 cage = normalize_or(at_sample(baker.low, sample, baker.cage), Vec3(0, 0, 1));
            const DetailSample seen = baker.look(point, cage, hits);
            report.missed += seen.found ? 0 : 1;
            report.from_point += seen.from_point ? 1 : 0;
            if (!seen.found) {
                continue;
            }
            // Where the surface bends away from the frame that the renderer has at the center of
            // the texel, each sample still is right in its own.
            normal += settings.object_space
                          ? seen.normal
                          : in_tangent_frame(
                              seen.normal, at_sample(baker.low, sample, baker.low.normals),
                              at_sample(baker.low, sample, baker.low.tangents));
            height += seen.height;
            if (!baker.sky.empty()) {
                occlusion += baker.open_sky(
                    seen.position, seen.normal,
                    static_cast<std::uint32_t>(texel) * 16u + static_cast<std::uint32_t>(k));
            }
            ++found;
        }
        report.covered += static_cast<std::size_t>(count);
        if (found > 0) {
            const auto share = 1 / static_cast<float>(found);
            covered[texel] = 1;
            bake.normal.texels[texel] = Vec4(encode_normal(normalize_or(normal, Vec3(0, 0, 1))), 1);
            bake.height.texels[texel] =
                Vec4(Vec3(0.5f + 0.5f * height * share / baker.distance), 1);
            if (!baker.sky.empty()) {
                bake.occlusion.texels[texel] = Vec4(Vec3(occlusion * share), 1);
            }
        }
    }
    return report;
}

}  // namespace

DetailRelief make_relief(const DetailBake& bake) {
    constexpr float kLeast = 1e-6f;  // of the distance: where both meshes coincide
    float low = INFINITY;
    float high = -INFINITY;
    for (const Vec4& texel : bake.height.texels) {
        low = std::min(low, texel.x);
        high = std::max(high, texel.x);
    }
    const auto meters = [&](float stored) { return (2 * stored - 1) * bake.distance; };
    DetailRelief relief = {
        .map = bake.normal,
        .raised = meters(high),
        .depth = std::max(meters(high) - meters(low), kLeast * bake.distance)};
    for (std::size_t i = 0; i < relief.map.texels.size(); ++i) {
        const float depth = (relief.raised - meters(bake.height.texels[i].x)) / relief.depth;
        relief.map.texels[i].w = std::clamp(depth, 0.0f, 1.0f);
    }
    return relief;
}

void move_out(MeshData& mesh, float distance) {
    const std::vector<Vec3> cage = cage_normals(mesh);
    mesh.bounds = {};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        mesh.positions[v] += distance * cage[v];
        if (is_finite(mesh.positions[v])) {
            grow(mesh.bounds, mesh.positions[v]);
        }
    }
    ++mesh.version;
}

Vec3 in_tangent_frame(const Vec3& n, const Vec3& normal, const Vec4& tangent) {
    const Vec3 t(tangent);
    const float sign = tangent.w < 0 ? -1.0f : 1.0f;
    const Vec3 b = sign * glm::cross(normal, t);
    const glm::mat3 frame(t, b, normal);
    const float determinant = glm::determinant(frame);
    if (!(std::abs(determinant) > 1e-9f)) {
        return {0, 0, 1};
    }
    return normalize_or(glm::inverse(frame) * n, Vec3(0, 0, 1));
}

void dilate(BakedMap& map, std::vector<std::uint8_t> covered, int rings) {
    LIMN_CHECK(covered.size() == map.texels.size());
    for (int ring = 0; ring < rings; ++ring) {
        const std::vector<std::uint8_t> old = covered;
        const std::vector<Vec4> values = map.texels;
        parallel_for(
            static_cast<std::size_t>(map.height), 16, [&](std::size_t begin, std::size_t end) {
                for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                    for (int x = 0; x < map.width; ++x) {
                        if (old[map.at(x, y)] != 0) {
                            continue;
                        }
                        Vec4 sum(0);
                        float count = 0;
                        for (int j = std::max(y - 1, 0); j <= std::min(y + 1, map.height - 1);
                             ++j) {
                            for (int i = std::max(x - 1, 0); i <= std::min(x + 1, map.width - 1);
                                 ++i) {
                                if (old[map.at(i, j)] != 0) {
                                    sum += values[map.at(i, j)];
                                    count += 1;
                                }
                            }
                        }
                        if (count > 0) {
                            map.texels[map.at(x, y)] = sum / count;
                            covered[map.at(x, y)] = 1;
                        }
                    }
                }
            });
    }
}

Result<DetailBake> bake_detail(
    const MeshData& low, const MeshData& high, const DetailSettings& settings,
    const RowProgress& progress) {
    LIMN_CHECK(settings.width > 0 && settings.height > 0);
    LIMN_CHECK(settings.samples >= 1 && settings.samples <= 4);
    LIMN_CHECK(low.normals.size() == low.positions.size());
    if (low.uvs.size() != low.positions.size() || low.tangents.size() != low.positions.size()) {
        return fail("{}: found no texture coordinates, expected them to bake to", low.name);
    }
    Bounds box;
    for (const Vec3& p : low.positions) {
        if (is_finite(p)) {
            grow(box, p);
        }
    }
    const float diagonal = is_empty(box) ? 0.0f : glm::length(box.max - box.min);
    DetailBaker baker = {
        .low = low,
        .high = high,
        .settings = settings,
        .caster = RayCaster(high.positions, high.indices),
        .cage = cage_normals(low),
        .charts = Charts(
            low.uvs, low.indices, settings.width * settings.samples,
            settings.height * settings.samples),
        .distance = std::max(settings.distance * diagonal, 1e-9f),
        .reach = std::max(settings.occlusion_reach * diagonal, 1e-9f),
        .sky = settings.occlusion_rays > 0 ? cosine_directions(settings.occlusion_rays)
                                           : std::vector<Vec3>()};
    if (baker.charts.empty()) {
        return fail(
            "{}: found no triangle with an area in texture space, expected charts to bake to",
            low.name);
    }
    DetailBake bake = {
        .normal = make_baked_map(
            settings.width, settings.height,
            settings.object_space ? Vec4(0.5f, 0.5f, 0.5f, 1) : Vec4(0.5f, 0.5f, 1, 1)),
        .height = make_baked_map(settings.width, settings.height, Vec4(0.5f, 0.5f, 0.5f, 1))};
    if (settings.occlusion_rays > 0) {
        bake.occlusion = make_baked_map(settings.width, settings.height, Vec4(1));
    }
    bake.distance = baker.distance;
    std::vector<std::uint8_t> covered(bake.normal.texels.size(), 0);
    std::vector<DetailReport> reports(static_cast<std::size_t>(settings.height));
    bake_rows(settings.height, progress, [&](int y) {
        std::vector<ChartSample> samples;
        DetailReport& report = reports[static_cast<std::size_t>(y)];
        report.overlapping = baker.charts.sample(y * settings.samples, settings.samples, samples);
        report += bake_row(baker, y, samples, bake, covered);
    });
    for (const DetailReport& report : reports) {
        bake.report += report;
    }
    bake.report.degenerate = baker.charts.degenerate();
    bake.report.outside = baker.charts.outside();
    for (BakedMap* const map : {&bake.normal, &bake.height, &bake.occlusion}) {
        if (!map->texels.empty()) {
            dilate(*map, covered, settings.padding);
        }
    }
    return bake;
}

}  // namespace limn
