#include "bench/fakephong/fakephong_report.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

// Techniques: fakephong.blinn-path, fakephong.metric-efficiency

namespace limn::fakephong {
namespace {

/// The six points where a method with `count` exact points samples: corners, or midpoints too.
bool is_sample(const ShadingMethod& method, std::size_t i) {
    return method.lightings == 6 || i % 2 == 0;
}

/// Calls visit(facet) for at most kMaxCheckedFacets facets that face the eye.
template <typename Visit>
void for_each_visible_facet(const PhongScene& scene, Visit visit) {
    Facet facet;
    const std::size_t stride = 1 + scene.mesh.triangles.size() / kMaxCheckedFacets;
    for (std::size_t i = 0; i < scene.mesh.triangles.size(); i += stride) {
        if (make_facet(scene.mesh, i, facet)
            && glm::dot(
                   plain(facet.face_normal), scene.camera.eye - plain(facet.corners[0].position))
                   > 0) {
            visit(facet);
        }
    }
}

/// Errors on the facets that face the eye.
void check_points(PhongScene scene, const ShadingMethod& method, MethodResult& result) {
    scene.texture_size = 0;
    const ShadingContext context = make_shading_context(scene);
    FacetSetup setup;
    const auto channel = [&method](const Lit& lit) {
        return clamp01(method.diffuse_only ? lit.tinted.x : lit.highlight.x).value;
    };
    for_each_visible_facet(scene, [&](const Facet& facet) {
        method.prepare(context, facet, setup);
        const auto error_at = [&](Real s, Real t, const SurfacePoint& point) {
            return std::abs(
                channel(method.shade(context, setup, s, t)) - channel(illuminate(scene, point)));
        };
        const auto points = six_points(facet);
        for (std::size_t i = 0; i < 6; ++i) {
            const auto& [s, t] = kSixPoints[i];
            const double error = error_at(s, t, points[i]);
            result.error_inside = std::max(result.error_inside, error);
            if (is_sample(method, i)) {
                result.error_at_samples = std::max(result.error_at_samples, error);
            }
        }
        for (const dvec2& st :
             {dvec2(1.0 / 3), dvec2(0.2, 0.2), dvec2(0.6, 0.2), dvec2(0.2, 0.6)}) {
            result.error_inside =
                std::max(result.error_inside, error_at(st.x, st.y, point_at(facet, st.x, st.y)));
        }
    });
}

/// Ids of the six methods of the table, by `key` ascending.
template <typename Key>
std::vector<std::string> rank(const SceneResult& result, Key key) {
    std::vector<std::pair<double, std::string>> ranked;
    for (std::size_t i = 0; i < kTableColumns; ++i) {
        ranked.emplace_back(key(result.methods[i]), std::string(result.methods[i].method->id));
    }
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) {
        return a.first < b.first;
    });
    std::vector<std::string> ids;
    for (const auto& [value, id] : ranked) {
        ids.push_back(id);
    }
    return ids;
}

}  // namespace

SceneResult evaluate_scene(const PhongScene& scene, const std::function<void(int done)>& progress) {
    const auto methods = shading_methods();
    PhongScene diffuse = scene;
    diffuse.channels = Channels::Diffuse;
    SceneResult result = {
        .scene = scene,
        .phong = draw(scene, methods[0]),
        .phong_diffuse = draw(diffuse, methods[0]),
        .methods = {}};
    for (const ShadingMethod& method : methods.subspan(1)) {
        const PhongScene& shaded = method.diffuse_only ? diffuse : scene;
        MethodResult one = {.method = &method, .image = draw(shaded, method)};
        const PhongImage& phong = reference_of(result, one);
        one.correctness = color_correctness(phong.color, one.image.color, phong.mask);
        one.scanline = compare_scanlines(
            scanline(phong.color, scene.row), scanline(one.image.color, scene.row));
        check_points(shaded, method, one);
        result.methods.push_back(std::move(one));
        if (progress) {
            progress(1 + static_cast<int>(result.methods.size()));
        }
    }
    return result;
}

std::array<double, kTableColumns> correctness_row(const PhongScene& scene) {
    const PhongImage phong = draw(scene, shading_methods()[0]);
    std::array<double, kTableColumns> row;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const PhongImage image = draw(scene, shading_methods()[i + 1]);
        row[i] = color_correctness(phong.color, image.color, phong.mask);
    }
    return row;
}

std::array<double, kTableColumns> correctness_row(const SceneResult& result) {
    std::array<double, kTableColumns> row;
    for (std::size_t i = 0; i < row.size(); ++i) {
        row[i] = result.methods[i].correctness;
    }
    return row;
}

int swapped_pairs(
    const std::array<double, kTableColumns>& row,
    const std::array<double, kTableColumns>& printed) {
    int swapped = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
        for (std::size_t j = 0; j < row.size(); ++j) {
            swapped += printed[i] < printed[j] && !(row[i] < row[j]) ? 1 : 0;
        }
    }
    return swapped;
}

const PhongImage& reference_of(const SceneResult& scene, const MethodResult& one) {
    return one.method->diffuse_only ? scene.phong_diffuse : scene.phong;
}

double weighted_operations(const Work& work) {
    return static_cast<double>(
        work.additions + work.multiplications + 4 * work.fetches + 8 * (work.divisions + work.roots)
        + 16 * work.powers);
}

double weighted_operations(const PhongImage& image) {
    return weighted_operations(image.setup) + weighted_operations(image.shading);
}

Efficiency efficiency_of(const PhongImage& image, const PhongImage& reference) {
    const auto per = [](std::int64_t count, std::int64_t of) {
        return static_cast<double>(count) / static_cast<double>(std::max<std::int64_t>(of, 1));
    };
    const auto per_pixel = [&](std::int64_t count) { return per(count, image.pixels); };
    const Work& w = image.shading;
    return {
        .lightings = per(image.setup.lightings, image.triangles),
        .additions = per_pixel(w.additions),
        .multiplications = per_pixel(w.multiplications),
        .divisions = per_pixel(w.divisions),
        .roots = per_pixel(w.roots),
        .powers = per_pixel(w.powers),
        .fetches = per_pixel(w.fetches),
        .work = weighted_operations(image) / std::max(weighted_operations(reference), 1.0)};
}

std::vector<std::string> rank_by_correctness(const SceneResult& result) {
    return rank(result, [](const MethodResult& one) { return -one.correctness; });
}

std::vector<std::string> rank_by_work(const SceneResult& result) {
    return rank(result, [](const MethodResult& one) { return weighted_operations(one.image); });
}

PathDeviation path_deviation(double angle) {
    // The largest distance of f(angle t) from the polynomial through t = 0, 1 and, if quadratic,
    // 1/2.
    const auto largest = [angle](double (*f)(double), bool quadratic) {
        const double r0 = f(0);
        const double r1 = f(0.5 * angle);
        const double r2 = f(angle);
        const double bend = quadratic ? 2 * (r0 - 2 * r1 + r2) : 0;
        double error = 0;
        constexpr int kSteps = 1000;
        for (int i = 0; i <= kSteps; ++i) {
            const double t = static_cast<double>(i) / kSteps;
            const double polynomial = r0 + (r2 - r0) * t - bend * t * (1 - t);
            error = std::max(error, std::abs(f(angle * t) - polynomial));
        }
        return error;
    };
    const auto sine_of = [](double x) { return std::sin(x); };
    const auto cosine_of = [](double x) { return std::cos(x); };
    return {
        largest(sine_of, false), largest(cosine_of, false), largest(sine_of, true),
        largest(cosine_of, true)};
}

EdgePaths edge_paths(const PhongScene& scene) {
    EdgePaths paths;
    const PhongLight& light = scene.lights[0];
    const auto angle = [](const dvec3& a, const dvec3& b) {
        return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
    };
    const auto edge = [&](const SurfacePoint& from, const SurfacePoint& to) {
        std::array<dvec2, kPathSamples + 1> at;
        double away = 0;
        for (std::size_t i = 0; i < at.size(); ++i) {
            const Real t = static_cast<double>(i) / kPathSamples;
            const SurfacePoint point = {
                (1.0 - t) * from.position + t * to.position,
                normalize_or((1.0 - t) * from.normal + t * to.normal, from.normal)};
            const dvec3 h =
                plain(half_vector(to_light(light, point.position), to_eye(scene, point.position)));
            away = std::max(away, angle(plain(point.normal), h));
            const Vec2r coordinates = blinn_coordinates(scene, light, point);
            at[i] = {coordinates.x.value, coordinates.y.value};
        }
        if (!(away < 1.57)) {
            return;
        }
        const dvec2 bend = 2.0 * (at[0] - 2.0 * at[kPathSamples / 2] + at[kPathSamples]);
        double linear = 0;
        double quadratic = 0;
        for (std::size_t i = 0; i < at.size(); ++i) {
            const double t = static_cast<double>(i) / kPathSamples;
            const dvec2 off = at[i] - glm::mix(at[0], at[kPathSamples], t);
            linear = std::max(linear, glm::length(off));
            quadratic = std::max(quadratic, glm::length(off + t * (1 - t) * bend));
        }
        ++paths.edges;
        paths.turn = std::max(paths.turn, angle(plain(from.normal), plain(to.normal)));
        paths.from_h = std::max(paths.from_h, away);
        paths.linear = std::max(paths.linear, linear);
        paths.quadratic = std::max(paths.quadratic, quadratic);
        paths.linear_mean += linear;
        paths.quadratic_mean += quadratic;
    };
    for_each_visible_facet(scene, [&](const Facet& facet) {
        for (std::size_t i = 0; i < 3; ++i) {
            edge(facet.corners[i], facet.corners[(i + 1) % 3]);
        }
    });
    paths.linear_mean /= std::max(paths.edges, 1);
    paths.quadratic_mean /= std::max(paths.edges, 1);
    return paths;
}

std::vector<SteppedMethod> step_scene(PhongScene scene) {
    std::vector<SteppedMethod> stepped;
    for (const ShadingMethod& method : shading_methods()) {
        if (method.degree > 0) {
            scene.interpolation = Interpolation::Perspective;
            const PhongImage perspective = draw(scene, method);
            scene.interpolation = Interpolation::Screen;
            SteppedMethod& one = stepped.emplace_back(SteppedMethod{
                .method = &method,
                .direct = draw(scene, method),
                .stepped = draw(scene, method, Evaluation::Differences)});
            one.correctness =
                color_correctness(perspective.color, one.direct.color, perspective.mask);
            for (std::size_t i = 0; i < one.direct.color.pixels.size(); ++i) {
                const Vec3 d = glm::abs(one.direct.color.pixels[i] - one.stepped.color.pixels[i]);
                one.difference =
                    std::max(one.difference, static_cast<double>(std::max({d.x, d.y, d.z})));
            }
        }
    }
    return stepped;
}

}  // namespace limn::fakephong
