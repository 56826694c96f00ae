#include "render/gpu/grown_buffer.h"

namespace limn::gpu {

Buffer
grown_buffer(std::string_view label, const Buffer& old, std::size_t kept, std::size_t bytes) {
    Buffer buffer(label, bytes, BufferUse::Dynamic);
    buffer.copy_from(old, 0, 0, kept);
    return buffer;
}

}  // namespace limn::gpu
