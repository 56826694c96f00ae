#include "render/gpu/debug_output.h"

#include "ecs/base/log.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <utility>

namespace limn::gpu {

struct DebugOutput::State {
    std::atomic<std::uint64_t> errors = 0;
    std::atomic<bool> muted = false;
    std::mutex mutex;  // drivers may report from their own threads
    std::vector<std::string> kept;
    // The previously installed callback, restored by the destructor.
    void* previous_callback = nullptr;
    void* previous_user = nullptr;
};

namespace {

constexpr std::size_t kMaxKept = 64;

const char* type_name(GLenum type) {
    switch (type) {
    case GL_DEBUG_TYPE_ERROR:
        return "error";
    case GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR:
        return "undefined behavior";
    default:
        return "message of high severity";
    }
}

void GLAPIENTRY receive_message(
    GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length, const GLchar* message,
    const void* user) {
    const bool is_error = type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR
                          || severity == GL_DEBUG_SEVERITY_HIGH;
    if (!is_error || source == GL_DEBUG_SOURCE_SHADER_COMPILER) {
        return;
    }
    auto& state = *static_cast<DebugOutput::State*>(const_cast<void*>(user));
    std::string text =
        length >= 0 ? std::string(message, static_cast<std::size_t>(length)) : message;
    while (!text.empty() && (text.back() == '\n' || text.back() == '\0')) {
        text.pop_back();
    }
    text = fmt::format("OpenGL {} {}: {}", type_name(type), id, text);
    state.errors.fetch_add(1);
    if (!state.muted) {
        log_error("{}", text);
    }
    const std::scoped_lock lock(state.mutex);
    if (state.kept.size() < kMaxKept) {
        state.kept.push_back(std::move(text));
    }
}

}  // namespace

DebugOutput::DebugOutput(bool synchronous) : state_(std::make_unique<State>()) {
    glEnable(GL_DEBUG_OUTPUT);
    if (synchronous) {
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    }
    glDebugMessageControl(
        GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0, nullptr, GL_FALSE);
    glGetPointerv(GL_DEBUG_CALLBACK_FUNCTION, &state_->previous_callback);
    glGetPointerv(GL_DEBUG_CALLBACK_USER_PARAM, &state_->previous_user);
    glDebugMessageCallback(receive_message, state_.get());
}

DebugOutput::~DebugOutput() {
    glDebugMessageCallback(
        reinterpret_cast<GLDEBUGPROC>(state_->previous_callback), state_->previous_user);
}

std::uint64_t DebugOutput::error_count() const {
    return state_->errors.load();
}

std::vector<std::string> DebugOutput::take_errors() {
    const std::scoped_lock lock(state_->mutex);
    return std::exchange(state_->kept, {});
}

void DebugOutput::set_muted(bool muted) {
    state_->muted = muted;
}

}  // namespace limn::gpu
