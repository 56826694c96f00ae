#pragma once

#include "content/load/files/json_document.h"
#include "content/load/level/component_json.h"
#include "ecs/base/result.h"
#include "ecs/components/motion_graph.h"

namespace limn {

/// Reads a motion graph of a level (ecs/components/motion_graph.h): `json` is an object with the
/// fields of MotionGraphData. Fails, with the place in the file, on states without a name or with
/// the same one, more than kMaxGraphClips clips or two at the same point, blend spaces without a
/// parameter, transitions from or to states that do not exist, transitions that nothing triggers,
/// and on a graph without states. A state without an exit is valid.
[[nodiscard]] Result<MotionGraphData>
read_motion_graph(const JsonValue& json, const JsonLocation& at, const NameResolver& names);

}  // namespace limn
