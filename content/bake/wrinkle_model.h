#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"

#include <span>
#include <vector>

namespace limn {

// Wrinkles as a function of the strain of skin, fitted to poses in which both are known
// (face.wrinkle-model; after Sanchez et al. 2004): at each texel, the slope of the wrinkles is a
// polynomial in the strain (tt, bb, tb) of the tangent frame, without a constant term, so that skin
// at rest is smooth. It models slopes instead of normals, so that every normal is unit and wrinkles
// can be added to other relief of the skin.
//
// The strain is clamped to the range of the poses and divided by its largest magnitude there: the
// polynomial is never extrapolated, and coefficients are of one order. Least squares with a ridge;
// K poses determine at most K terms.

/// A pose: one element per texel.
struct WrinklePose {
    std::vector<Vec3> strain;  ///< tt, bb, tb
    std::vector<Vec2> slopes;  ///< of the wrinkles, along tangent and bitangent: -n.xy / n.z
};

struct WrinkleModelOptions {
    int degree = 2;       ///< 1 .. 3
    float ridge = 1e-4f;  ///< added to the diagonal of the normal equations, > 0
};

/// Terms of a polynomial of `degree` (1 .. 3) in three variables, without the constant: 3, 9, 19.
[[nodiscard]] int wrinkle_terms(int degree);

struct WrinkleModel {
    int size = 0;  ///< [texels] along each side
    int degree = 2;
    std::vector<Vec3> min_strain;    ///< of the poses, <= 0
    std::vector<Vec3> max_strain;    ///< of the poses, >= 0
    std::vector<Vec2> coefficients;  ///< wrinkle_terms(degree) per texel
};

/// Each pose has size * size elements. A texel that is not finite in any pose has no wrinkles.
[[nodiscard]] WrinkleModel
fit_wrinkle_model(int size, std::span<const WrinklePose> poses, const WrinkleModelOptions& options);

/// The slope at a texel of skin with this strain.
[[nodiscard]] Vec2 modeled_slope(const WrinkleModel& model, std::size_t texel, const Vec3& strain);

/// The layout that shaders read (lib/wrinkle_model.glsl): Rgba16F tiles of size x size, one below
/// the other: the range of tt and of bb, that of tb, then two terms each.
[[nodiscard]] ImageData pack_wrinkle_model(const WrinkleModel& model);

}  // namespace limn
