#pragma once

#include "content/make/patterns/pattern_maps.h"
#include "ecs/reflect.h"

namespace limn {

/// The folds of face_folds as a model of the strain (content/bake/wrinkle_model.h), for the wrinkle
/// method `model` on the skin of the mesh "head" of that age: fitted to sixteen expressions, whose
/// wrinkles are known because small folds preserve the length of the skin. Only its normal map is a
/// model.
struct StrainFoldsPattern {
    int size = 512;
    int seed = 1;
    float depth = 1;
    float wander = 0.35f;
    float age = 0.3f;
    int degree = 2;
    float ridge = 1e-4f;
    float slack = 0.03f;
    float share = 0.3f;
};

LIMN_FIELDS(StrainFoldsPattern) {
    LIMN_FIELD(size, "texels along each side", "", 1, 1024);
    LIMN_FIELD(seed, "random seed", "", 0, 2147483647);
    LIMN_FIELD(depth, "depth of all folds, as in face_folds", "", 0, 4);
    LIMN_FIELD(wander, "irregularity of folds, sideways", "mm", 0, 5);
    LIMN_FIELD(age, "age of the head, as there", "", 0, 1);
    LIMN_FIELD(degree, "degree of the polynomial", "", 1, 3);
    LIMN_FIELD(ridge, "ridge parameter (Tikhonov) of the least squares", "", 1e-8, 1);
    LIMN_FIELD(slack, "shortening that skin absorbs without folding", "", 0, 1);
    LIMN_FIELD(share, "fraction of the shortening beyond slack that becomes folds", "", 0, 1);
}

[[nodiscard]] PatternMaps make_strain_folds(const StrainFoldsPattern& pattern);

}  // namespace limn
