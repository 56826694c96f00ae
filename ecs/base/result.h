#pragma once

#include "ecs/base/check.h"

#include <string>
#include <utility>
#include <variant>

namespace limn {

// Functions that can fail for external reasons return a Result: the value, or a one-line error
// with file, position, what was found and what was expected. It cannot be ignored.
//
//     Result<Image> image = load_image(path);
//     if (!image) return image.error();
//     use(*image);

/// One line for a person: "scene.gltf: accessor 3: 90 bytes found, 96 expected".
struct Error {
    std::string message;
};

template <typename T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    [[nodiscard]] T& value() & {
        LIMN_CHECK_NOTE(ok(), message_or_null());
        return *std::get_if<0>(&state_);
    }
    [[nodiscard]] const T& value() const& {
        LIMN_CHECK_NOTE(ok(), message_or_null());
        return *std::get_if<0>(&state_);
    }
    [[nodiscard]] T&& value() && {
        LIMN_CHECK_NOTE(ok(), message_or_null());
        return std::move(*std::get_if<0>(&state_));
    }
    [[nodiscard]] T& operator*() & { return value(); }
    [[nodiscard]] const T& operator*() const& { return value(); }
    [[nodiscard]] T&& operator*() && { return std::move(*this).value(); }
    [[nodiscard]] T* operator->() { return &value(); }
    [[nodiscard]] const T* operator->() const { return &value(); }

    [[nodiscard]] const Error& error() const {
        LIMN_CHECK(!ok());
        return *std::get_if<1>(&state_);
    }

  private:
    const char* message_or_null() const {
        const Error* error = std::get_if<1>(&state_);
        return error != nullptr ? error->message.c_str() : nullptr;
    }
    std::variant<T, Error> state_;
};

/// For operations that succeed without a value: `return Done{};`
struct Done {};
using Status = Result<Done>;

}  // namespace limn

/// The value of a Result or Status; where it failed, returns its error from the calling function:
/// `const Image image = LIMN_TRY(load_image(path));`
#define LIMN_TRY(...)                                                                              \
    ({                                                                                             \
        auto&& limn_tried = (__VA_ARGS__);                                                         \
        if (!limn_tried) {                                                                         \
            return limn_tried.error();                                                             \
        }                                                                                          \
        *std::move(limn_tried);                                                                    \
    })
