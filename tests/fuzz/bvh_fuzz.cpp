// Bytes into the BVH reader, and the skeleton, clip and scene made of them: whatever they are, all
// are valid, or there is one line.

#include "content/load/motion/bvh_export.h"
#include "content/load/motion/bvh_file.h"
#include "content/load/motion/bvh_motion.h"
#include "content/load/motion/motion_scene.h"

#include <cstdlib>
#include <string_view>

namespace {

constexpr limn::BvhLimits kLimits = {
    .max_bytes = 1 << 20, .max_joints = 60, .max_frames = 200, .max_values = 4000};

void require(bool condition) {
    if (!condition) {
        std::abort();
    }
}

template <typename T>
bool is_made(const limn::Result<T>& result) {
    if (!result) {
        require(!result.error().message.empty());
        require(result.error().message.find('\n') == std::string::npos);
    }
    return result.ok();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto bvh = limn::parse_bvh(text, "fuzz.bvh", kLimits);
    if (!is_made(bvh)) {
        return 0;
    }
    require(bvh->values.size() == bvh->frames * bvh->channels());
    const auto again = limn::parse_bvh(limn::write_bvh(*bvh), "again.bvh", kLimits);
    require(is_made(again));
    require(again->values == bvh->values && again->frame_time == bvh->frame_time);
    const auto motion = limn::make_bvh_motion(*bvh, "fuzz");
    if (is_made(motion)) {
        require(limn::check_skeleton(motion->skeleton).ok());
        require(limn::check_clip(motion->clip, motion->skeleton.joints.size(), 0).ok());
        const limn::GltfScene scene = limn::make_motion_scene("fuzz", *motion);
        require(limn::check_skeleton(scene.skeleton).ok());
        if (motion->clip.duration < 10) {
            const limn::BvhFile file = limn::make_bvh_file(*motion, 10);
            require(file.values.size() == file.frames * file.channels());
        }
    }
    return 0;
}
