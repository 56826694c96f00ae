#pragma once

#include "content/make/head/head.h"
#include "content/make/head/head_action_units.h"
#include "content/make/head/head_expressions.h"
#include "content/make/head/head_layout.h"
#include "content/make/head/head_wrap.h"

#include <vector>

namespace limn::test {

/// Points of the skin of the default head, one per vertex of its layout [cm].
inline const std::vector<HeadPoint>& head_skin() {
    static const std::vector<HeadPoint> points = [] {
        const std::vector<Vec3> rest = wrap_head({});
        std::vector<HeadPoint> made;
        for (std::size_t v = 0; v < rest.size(); ++v) {
            made.push_back(skin_point(head_layout().vertices[v], rest[v]));
        }
        return made;
    }();
    return points;
}

/// Its morph targets.
inline const std::vector<MorphTarget>& head_shapes() {
    static const std::vector<MorphTarget> made = make_expressions(head_skin(), {});
    return made;
}

}  // namespace limn::test
