// Bytes into the HTR reader: whatever they are, the skeleton and the clip are valid, or there is
// one line.

#include "content/load/motion/htr_file.h"

#include <cstdlib>
#include <string_view>

namespace {

constexpr limn::HtrLimits kLimits = {
    .max_bytes = 1 << 20, .max_joints = 60, .max_frames = 200, .max_keys = 4000};

void require(bool condition) {
    if (!condition) {
        std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto motion = limn::parse_htr(text, "fuzz.htr", kLimits);
    if (!motion) {
        require(!motion.error().message.empty());
        require(motion.error().message.find('\n') == std::string::npos);
        return 0;
    }
    require(limn::check_skeleton(motion->skeleton).ok());
    require(limn::check_clip(motion->clip, motion->skeleton.joints.size(), 0).ok());
    return 0;
}
