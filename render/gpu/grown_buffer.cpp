#include "render/gpu/grown_buffer.h"

namespace limn::gpu {

Buffer
grown_buffer(std::string_view label, const Buffer& old, std::size_t kept, std::size_t bytes) {
    Buffer buffer(label, bytes, BufferUse::Dynamic);
    if (kept > 0) {
        glCopyNamedBufferSubData(old.id(), buffer.id(), 0, 0, static_cast<GLsizeiptr>(kept));
        // NVIDIA's driver (580) lets this copy overtake a later glNamedBufferSubData into the same
        // range, and what was written is lost. Pools grow rarely, by doubling: wait.
        glFinish();
    }
    return buffer;
}

}  // namespace limn::gpu
