#pragma once

#include "ecs/base/result.h"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace limn {

// Sentences with values in them, for errors and the log:
//
//     return fail("{}: found {}, expected {}", path, value, limit);
//
// Each {} is replaced by the next argument: text, bool, a whole number, or a float or double in as
// few digits as tell it apart from its neighbors. There is nothing to adjust between the braces, so
// that a braces pair is all one has to know; tables are made with the functions at the end. How
// many {} there are is checked by the compiler.

/// One argument of format_text.
class TextPart {
  public:
    TextPart(std::string_view text) : kind_(Kind::Text), text_(text) {}
    TextPart(const char* text) : TextPart(std::string_view(text)) {}
    TextPart(const std::string& text) : TextPart(std::string_view(text)) {}
    TextPart(const void*) = delete;  // or any pointer would pass for a bool
    TextPart(bool value) : TextPart(std::string_view(value ? "true" : "false")) {}
    TextPart(char letter) : kind_(Kind::Letter), letter_(letter) {}
    template <std::signed_integral T>
    TextPart(T number) : kind_(Kind::Signed), signed_(number) {}
    template <std::unsigned_integral T>
    TextPart(T number) : kind_(Kind::Unsigned), unsigned_(number) {}
    TextPart(float number) : kind_(Kind::Float), float_(number) {}
    TextPart(double number) : kind_(Kind::Double), double_(number) {}

    void append_to(std::string& text) const;

  private:
    enum class Kind : std::uint8_t { Text, Letter, Signed, Unsigned, Float, Double };
    Kind kind_;
    union {
        std::string_view text_;
        char letter_;
        std::int64_t signed_;
        std::uint64_t unsigned_;
        float float_;
        double double_;
    };
};

/// A text with as many {} as there are Args; another number does not compile.
template <typename... Args>
struct TextPattern {
    std::string_view text;

    template <std::convertible_to<std::string_view> Text>
    consteval TextPattern(const Text& pattern) : text(pattern) {
        std::size_t places = 0;
        for (std::size_t i = 0; i + 1 < text.size(); ++i) {
            places += text[i] == '{' && text[i + 1] == '}' ? 1 : 0;
        }
        if (places != sizeof...(Args)) {
            throw "there must be one {} for each argument";
        }
    }
};

/// `pattern` with its {} replaced by `parts`, of which there are as many.
[[nodiscard]] std::string replace_places(std::string_view pattern, std::span<const TextPart> parts);

template <typename... Args>
[[nodiscard]] std::string
format_text(TextPattern<std::type_identity_t<Args>...> pattern, const Args&... args) {
    if constexpr (sizeof...(Args) == 0) {
        return std::string(pattern.text);
    } else {
        const TextPart parts[] = {TextPart(args)...};
        return replace_places(pattern.text, parts);
    }
}

/// The error with that text: `return fail("{}: no such file", path);`
template <typename... Args>
[[nodiscard]] Error fail(TextPattern<std::type_identity_t<Args>...> pattern, const Args&... args) {
    return Error{format_text<Args...>(pattern, args...)};
}

/// With `digits` behind the point: "0.250".
[[nodiscard]] std::string fixed_text(double number, int digits);

/// Filled up with spaces, before or behind, to `width` characters; longer text stays as it is.
[[nodiscard]] std::string align_right(const TextPart& part, std::size_t width);
[[nodiscard]] std::string align_left(const TextPart& part, std::size_t width);

/// All of them with `separator` between.
template <typename Range>
[[nodiscard]] std::string join_text(const Range& parts, std::string_view separator) {
    std::string text;
    for (const auto& part : parts) {
        text += text.empty() ? std::string_view() : separator;
        TextPart(part).append_to(text);
    }
    return text;
}

}  // namespace limn
