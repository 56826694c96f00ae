#pragma once

#include "render/gpu/buffer.h"

namespace limn::gpu {

/// A Dynamic buffer of `bytes` that begins with the first `kept` bytes of `old`: for pools that
/// only append.
[[nodiscard]] Buffer
grown_buffer(std::string_view label, const Buffer& old, std::size_t kept, std::size_t bytes);

}  // namespace limn::gpu
