#include "bench/fakephong/fakephong_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace limn::fakephong {
namespace {

/// The six points where a method with `count` exact points samples: corners, or midpoints too.
bool is_sample(const ShadingMethod& method, std::size_t i) {
    return method.lightings == 6 || i % 2 == 0;
}

/// Errors of highlights on the facets that face the eye.
void check_points(PhongScene scene, const ShadingMethod& method, MethodResult& result) {
    scene.texture_size = 0;
    const ShadingContext context = make_shading_context(scene);
    FacetSetup setup;
    Facet facet;
    const std::size_t stride = 1 + scene.mesh.triangles.size() / kMaxCheckedFacets;
    for (std::size_t f = 0; f < scene.mesh.triangles.size(); f += stride) {
        if (!make_facet(scene.mesh, f, facet)
            || !(
                glm::dot(
                    plain(facet.face_normal), scene.camera.eye - plain(facet.corners[0].position))
                > 0)) {
            continue;
        }
        method.prepare(context, facet, setup);
        const auto error_at = [&](Real s, Real t, const SurfacePoint& point) {
            const double found = clamp01(method.shade(context, setup, s, t).highlight.x).value;
            const double wanted = clamp01(illuminate(scene, point).highlight.x).value;
            return std::abs(found - wanted);
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
    }
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
    SceneResult result = {.scene = scene, .phong = draw(scene, methods[0]), .methods = {}};
    const std::vector<float> wanted = scanline(result.phong.color, scene.row);
    for (const ShadingMethod& method : methods.subspan(1)) {
        MethodResult one = {.method = &method, .image = draw(scene, method)};
        one.correctness = color_correctness(result.phong.color, one.image.color, result.phong.mask);
        one.scanline = compare_scanlines(wanted, scanline(one.image.color, scene.row));
        check_points(scene, method, one);
        result.methods.push_back(std::move(one));
        if (progress) {
            progress(1 + static_cast<int>(result.methods.size()));
        }
    }
    return result;
}

double weighted_operations(const Work& work) {
    return static_cast<double>(
        work.additions + work.multiplications + 4 * work.fetches + 8 * (work.divisions + work.roots)
        + 16 * work.powers);
}

std::vector<std::string> rank_by_correctness(const SceneResult& result) {
    return rank(result, [](const MethodResult& one) { return -one.correctness; });
}

std::vector<std::string> rank_by_work(const SceneResult& result) {
    return rank(result, [](const MethodResult& one) {
        return weighted_operations(one.image.setup) + weighted_operations(one.image.shading);
    });
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

}  // namespace limn::fakephong
