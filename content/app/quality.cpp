#include "content/app/quality.h"

#include "content/app/quality_caustics.h"
#include "content/app/quality_dof.h"
#include "content/app/quality_glow.h"
#include "content/app/quality_lights.h"
#include "content/app/quality_motion_blur.h"
#include "content/app/quality_ripple.h"
#include "content/app/quality_shadows.h"
#include "content/app/quality_skinning.h"
#include "content/app/quality_surfaces.h"
#include "content/app/quality_tone.h"
#include "content/app/quality_velocity.h"
#include "content/app/quality_water.h"

namespace limn {

std::span<const QualityEffect> quality_effects() {
    static constexpr QualityEffect kEffects[] = {
        {"surfaces",
         "the reflection models in double precision, at the point that each pixel shows",
         measure_surfaces},
        {"lights", "all lights at the point that each pixel shows, in double precision",
         measure_lights_quality},
        {"shadows", "rays from the point that each pixel shows to the light, in double precision",
         measure_shadows},
        {"tone", "statistics and tone operators in double precision, with true Gaussians",
         measure_tone},
        {"skinning", "joints and morph targets in double precision", measure_skinning},
        {"velocity",
         "rays in double precision to triangles whose corners are known at both moments",
         measure_velocity},
        {"motion-blur", "the mean of 128 pictures of moments within the exposure",
         measure_motion_blur},
        {"dof", "the mean of what 256 points of the lens see", measure_dof},
        {"glow", "a convolution in double precision, and the laws of light", measure_glow},
        {"ripple", "shifts by geometry in double precision", measure_ripple},
        {"water", "Fourier sums term by term in double precision, the dispersion relation",
         measure_water},
        {"caustics",
         "ten million photons through the same waves in double precision, and the laws of light",
         measure_caustics},
    };
    return kEffects;
}

bool holds(const QualityRow& row) {
    switch (row.bound) {
    case QualityBound::AtMost:
        return row.found <= row.limit;
    case QualityBound::AtLeast:
        return row.found >= row.limit;
    case QualityBound::None:
        return true;
    }
    return false;
}

}  // namespace limn
