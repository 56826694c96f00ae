#include "render/gpu/gpu_query.h"

#include "ecs/base/check.h"

namespace limn::gpu {
namespace {

GLuint create_query_name(GLenum target) {
    GLuint id = 0;
    glCreateQueries(target, 1, &id);
    return id;
}

}  // namespace

GpuQuery::GpuQuery(std::string_view label, GLenum target)
    : object_(create_query_name(target), label), target_(target) {}

void GpuQuery::begin() {
    glBeginQuery(target_, object_.id());
    issued_ = false;
}

void GpuQuery::end() {
    glEndQuery(target_);
    issued_ = true;
}

void GpuQuery::timestamp() {
    LIMN_CHECK(target_ == GL_TIMESTAMP);
    glQueryCounter(object_.id(), GL_TIMESTAMP);
    issued_ = true;
}

std::optional<std::uint64_t> GpuQuery::poll() const {
    if (!issued_) {
        return std::nullopt;
    }
    GLint available = GL_FALSE;
    glGetQueryObjectiv(object_.id(), GL_QUERY_RESULT_AVAILABLE, &available);
    return available == GL_TRUE ? std::optional(wait()) : std::nullopt;
}

std::uint64_t GpuQuery::wait() const {
    LIMN_CHECK(issued_);
    GLuint64 result = 0;
    glGetQueryObjectui64v(object_.id(), GL_QUERY_RESULT, &result);
    return result;
}

}  // namespace limn::gpu
