#pragma once

#include "bench/fakephong/phong_raster.h"
#include "bench/fakephong/phong_scene.h"
#include "bench/fakephong/shading_method.h"
#include "content/bake/image_compare.h"

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace limn::fakephong {

// The measures of the thesis (fakephong.metric-*, .blinn-path, .results).
// Techniques: fakephong.forward-difference, fakephong.metric-analytic, fakephong.results

/// One method on one scene: its highlights, or its diffuse light if it has no others.
struct MethodResult {
    const ShadingMethod* method = nullptr;
    PhongImage image = {};
    double correctness = 1;            ///< fakephong.metric-color, compared with Phong shading
    ScanlineComparison scanline = {};  ///< along scene.row; a is Phong shading
    double error_at_samples = 0;       ///< at its own sample points, not rounded
    double error_inside = 0;           ///< and anywhere on visible facets
};

struct SceneResult {
    PhongScene scene;
    PhongImage phong;                   ///< highlights
    PhongImage phong_diffuse;           ///< reference of methods without highlights
    std::vector<MethodResult> methods;  ///< shading_methods() without the first
};
[[nodiscard]] const PhongImage& reference_of(const SceneResult& scene, const MethodResult& one);
/// Draws `scene` with every method; `progress`, if any, receives the number of methods done.
/// Samples are checked with textures evaluated exactly, so that the remaining error is the method's
/// own, on at most kMaxCheckedFacets spread over the mesh.
[[nodiscard]] SceneResult
evaluate_scene(const PhongScene& scene, const std::function<void(int done)>& progress = {});
inline constexpr std::size_t kMaxCheckedFacets = 20000;

/// A single row of Table 6.1.
[[nodiscard]] std::array<double, kTableColumns> correctness_row(const PhongScene& scene);

/// Pairs of columns of a row, as many as `printed` orders, that are not in its order.
[[nodiscard]] int swapped_pairs(
    const std::array<double, kTableColumns>& row, const std::array<double, kTableColumns>& printed);
/// The row of a scene that has been evaluated.
[[nodiscard]] std::array<double, kTableColumns> correctness_row(const SceneResult& result);

/// The ids of Table 6.1's methods by a value, best first; equal ones keep the order of the table.
[[nodiscard]] std::vector<std::string> rank_by_correctness(const SceneResult& result);
/// By the counted operations of a frame: additions and multiplications 1, fetches 4, divisions and
/// roots 8, powers 16; weights chosen for a processor of the time.
[[nodiscard]] std::vector<std::string> rank_by_work(const SceneResult& result);
[[nodiscard]] double weighted_operations(const Work& work);

/// A frame, set-up included.
[[nodiscard]] double weighted_operations(const PhongImage& image);

/// A line of the efficiency table (fakephong.metric-efficiency).
struct Efficiency {
    double lightings = 0;  ///< per facet
    double additions = 0, multiplications = 0, divisions = 0, roots = 0, powers = 0,
           fetches = 0;  ///< per pixel
    double work = 0;     ///< weighted operations of the frame over those of `reference`
};
[[nodiscard]] Efficiency efficiency_of(const PhongImage& image, const PhongImage& reference);

/// Largest difference between the sine or cosine of 0 .. `angle` [rad] and the polynomial through
/// the ends of that arc, or through its ends and center: the error of Blinn coordinates along an
/// edge whose normals turn by `angle` from H.
struct PathDeviation {
    double linear_sine = 0, linear_cosine = 0;
    double quadratic_sine = 0, quadratic_cosine = 0;
};
[[nodiscard]] PathDeviation path_deviation(double angle);

/// The edges of visible facets (fakephong.blinn-path): distance of the path of the Blinn
/// coordinates of linear, renormalized normals from the line through its ends, and from the
/// quadratic through its ends and center. Edges on which a normal points away from H are excluded:
/// their paths end at the rim.
struct EdgePaths {
    int edges = 0;
    double turn = 0;                   ///< largest angle between the normals of an edge [rad]
    double from_h = 0;                 ///< largest angle between a normal and H [rad]
    double linear = 0, quadratic = 0;  ///< largest distance in the unit disc
    double linear_mean = 0, quadratic_mean = 0;  ///< mean over edges of their largest distance
};
/// By the first light, at kPathSamples points of each edge of at most kMaxCheckedFacets facets.
[[nodiscard]] EdgePaths edge_paths(const PhongScene& scene);
inline constexpr int kPathSamples = 16;

/// A method whose colors are polynomials, without perspective: evaluated at each pixel, and stepped
/// by forward differences (fakephong.forward-difference).
struct SteppedMethod {
    const ShadingMethod* method = nullptr;
    PhongImage direct = {};
    PhongImage stepped = {};
    double difference = 0;   ///< largest difference of the two images
    double correctness = 1;  ///< of either image, compared with the method's own with perspective
};
[[nodiscard]] std::vector<SteppedMethod> step_scene(PhongScene scene);

}  // namespace limn::fakephong
