#include "render/gpu/undefined_memory.h"

#include <cstdlib>
#include <string_view>

namespace limn::gpu {

bool fills_undefined_memory() {
    const char* const found = std::getenv("LIMN_UNDEFINED");
    return found != nullptr && std::string_view(found) == "nan";
}

}  // namespace limn::gpu
