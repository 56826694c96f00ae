#pragma once

#include "content/make/head/head_action_units.h"
#include "ecs/components/skeleton.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// The expressions of a head as morph targets: halves of action units that are sided, other units as
// a whole, then visemes; last what follows these (head_correctives.h), as "AU43_L_half" and
// "AU43_L_AU7_L". All parts of a head have the same list.

/// One target for each shape; a target without vertices moves none. `points`: one per vertex.
/// Normals are left to generate_morph_normals.
[[nodiscard]] std::vector<MorphTarget>
make_expressions(std::span<const HeadPoint> points, const HeadShape& shape);

/// Of all targets that have no drivers, in their order, from the first on.
[[nodiscard]] std::vector<std::string> expression_names();

/// How many targets there are; the index of one that is added to them.
[[nodiscard]] std::uint16_t expression_count();

/// Index of the target called `name`, which must exist.
[[nodiscard]] std::uint16_t expression_index(std::string_view name);

}  // namespace limn
