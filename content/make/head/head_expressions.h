#pragma once

#include "content/make/head/head_action_units.h"
#include "ecs/components/skeleton.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// The expressions of a head as morph targets: halves of sided action units, other units as a whole,
// then visemes; last the shapes that these drive (head_correctives.h), such as "AU43_L_half" and
// "AU43_L_AU7_L". All parts of a head have the same list.

/// One target per shape, possibly without vertices. `points`: one per vertex. Normals are left to
/// generate_morph_normals.
[[nodiscard]] std::vector<MorphTarget>
make_expressions(std::span<const HeadPoint> points, const HeadShape& shape);

/// Names of all targets without drivers, which come first, in order.
[[nodiscard]] std::vector<std::string> expression_names();

/// Number of targets, and the index of one that is appended.
[[nodiscard]] std::uint16_t expression_count();

/// Index of the target called `name`, which must exist.
[[nodiscard]] std::uint16_t expression_index(std::string_view name);

}  // namespace limn
