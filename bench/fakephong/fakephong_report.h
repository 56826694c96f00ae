#pragma once

#include "bench/fakephong/phong_raster.h"
#include "bench/fakephong/phong_scene.h"
#include "bench/fakephong/shading_method.h"
#include "content/bake/image_compare.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace limn::fakephong {

// The measures of the thesis (fakephong.metric-*, .blinn-path, .results).

/// One method on one scene.
struct MethodResult {
    const ShadingMethod* method = nullptr;
    PhongImage image = {};
    double correctness = 1;            ///< fakephong.metric-color against Phong shading
    ScanlineComparison scanline = {};  ///< along scene.row; a is Phong shading
    double error_at_samples = 0;       ///< of highlights at its own sample points, not rounded
    double error_inside = 0;           ///< and anywhere on the facets that are seen
};

struct SceneResult {
    PhongScene scene;
    PhongImage phong;
    std::vector<MethodResult> methods;  ///< shading_methods() without the first
};
/// Draws `scene` by every method; `progress`, if any, is told how many are done. Samples are
/// checked with textures evaluated exactly, so that what is left is the method's own, on at most
/// kMaxCheckedFacets spread over the mesh.
[[nodiscard]] SceneResult
evaluate_scene(const PhongScene& scene, const std::function<void(int done)>& progress = {});
inline constexpr std::size_t kMaxCheckedFacets = 20000;

/// The ids of Table 6.1's methods by a value, best first; equal ones keep the order of the table.
[[nodiscard]] std::vector<std::string> rank_by_correctness(const SceneResult& result);
/// By the counted operations of a frame: additions and multiplications 1, fetches 4, divisions and
/// roots 8, powers 16; weights chosen, as of a processor of the time.
[[nodiscard]] std::vector<std::string> rank_by_work(const SceneResult& result);
[[nodiscard]] double weighted_operations(const Work& work);

/// Largest difference between the sine or cosine of 0 .. `angle` [rad] and the polynomial through
/// the ends of that arc, or through its ends and middle: what Blinn coordinates lose along an edge
/// whose normals turn by `angle` from H.
struct PathDeviation {
    double linear_sine = 0, linear_cosine = 0;
    double quadratic_sine = 0, quadratic_cosine = 0;
};
[[nodiscard]] PathDeviation path_deviation(double angle);

}  // namespace limn::fakephong
