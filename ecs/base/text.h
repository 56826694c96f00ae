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

// Text formatting for errors and the log:
//
//     return fail("{}: found {}, expected {}", path, value, limit);
//
// Each {} is replaced by the next argument: text, bool, an integer, or a float or double in the
// fewest digits that round-trip. There are no format specifiers; tables are made with the functions
// at the end. The number of {} is checked at compile time.

/// One argument of format_text.
class TextPart {
  public:
    TextPart(std::string_view text) : kind_(Kind::Text), text_(text) {}
    TextPart(const char* text) : TextPart(std::string_view(text)) {}
    TextPart(const std::string& text) : TextPart(std::string_view(text)) {}
    TextPart(const void*) = delete;  // otherwise pointers would convert to bool
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

/// A text with exactly as many {} as there are Args, checked at compile time.
template <typename... Args>
struct TextPattern {
    std::string_view text;

    template <std::convertible_to<std::string_view> Text>
    consteval TextPattern(const Text& pattern) : text(pattern) {
        std::size_t placeholders = 0;
        for (std::size_t i = 0; i + 1 < text.size(); ++i) {
            placeholders += text[i] == '{' && text[i + 1] == '}' ? 1 : 0;
        }
        if (placeholders != sizeof...(Args)) {
            throw "there must be one {} for each argument";
        }
    }
};

/// `pattern` with each {} replaced by one of `parts`; their numbers must match.
[[nodiscard]] std::string
replace_placeholders(std::string_view pattern, std::span<const TextPart> parts);

template <typename... Args>
[[nodiscard]] std::string
format_text(TextPattern<std::type_identity_t<Args>...> pattern, const Args&... args) {
    if constexpr (sizeof...(Args) == 0) {
        return std::string(pattern.text);
    } else {
        const TextPart parts[] = {TextPart(args)...};
        return replace_placeholders(pattern.text, parts);
    }
}

/// An Error with formatted text: `return fail("{}: no such file", path);`
template <typename... Args>
[[nodiscard]] Error fail(TextPattern<std::type_identity_t<Args>...> pattern, const Args&... args) {
    return Error{format_text<Args...>(pattern, args...)};
}

/// With `digits` after the decimal point: "0.250".
[[nodiscard]] std::string fixed_text(double number, int digits);

/// Padded with spaces, on the left or right, to `width` characters; longer text is unchanged.
[[nodiscard]] std::string align_right(const TextPart& part, std::size_t width);
[[nodiscard]] std::string align_left(const TextPart& part, std::size_t width);

/// Concatenates `parts` with `separator` in between.
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
