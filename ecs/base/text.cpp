#include "ecs/base/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace limn {

namespace {

/// Powers of ten from which up, and from which down, numbers are written with an exponent.
constexpr int kFirstLarge = 16;
constexpr int kLastSmall = -5;

template <typename Number>
void append_integer(std::string& text, Number number) {
    char digits[24];
    const std::to_chars_result end = std::to_chars(digits, digits + sizeof digits, number);
    text.append(digits, end.ptr);
}

/// The fewest digits that round-trip, as 0.001, 1500 or 1.5e-07.
template <typename Number>
void append_shortest(std::string& text, Number number) {
    if (!std::isfinite(number)) {
        text += std::signbit(number) ? "-" : "";
        text += std::isnan(number) ? "nan" : "inf";
        return;
    }
    char buffer[32];  // [-]d[.ddd]e[+-]dd
    const std::to_chars_result end =
        std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::scientific);
    const std::string_view written(buffer, static_cast<std::size_t>(end.ptr - buffer));
    const std::size_t mark = written.find('e');
    int exponent = 0;
    const char* const first = written.data() + mark + 1;
    std::from_chars(*first == '+' ? first + 1 : first, end.ptr, exponent);
    if (exponent <= kLastSmall || exponent >= kFirstLarge) {
        text += written;
        return;
    }
    std::string digits;
    for (const char c : written.substr(0, mark)) {
        if (c == '-') {
            text += c;
        } else if (c != '.') {
            digits += c;
        }
    }
    if (exponent < 0) {
        text += "0.";
        text.append(static_cast<std::size_t>(-exponent - 1), '0');
        text += digits;
        return;
    }
    const std::size_t before_point = static_cast<std::size_t>(exponent) + 1;
    digits.resize(std::max(digits.size(), before_point), '0');
    text.append(digits, 0, before_point);
    if (digits.size() > before_point) {
        text += '.';
        text.append(digits, before_point);
    }
}

}  // namespace

void TextPart::append_to(std::string& text) const {
    switch (kind_) {
    case Kind::Text:
        text += text_;
        break;
    case Kind::Letter:
        text += letter_;
        break;
    case Kind::Signed:
        append_integer(text, signed_);
        break;
    case Kind::Unsigned:
        append_integer(text, unsigned_);
        break;
    case Kind::Float:
        append_shortest(text, float_);
        break;
    case Kind::Double:
        append_shortest(text, double_);
        break;
    }
}

std::string replace_placeholders(std::string_view pattern, std::span<const TextPart> parts) {
    std::string text;
    text.reserve(pattern.size() + 16 * parts.size());
    for (const TextPart& part : parts) {
        const std::size_t position = pattern.find("{}");
        text += pattern.substr(0, position);
        part.append_to(text);
        pattern.remove_prefix(position + 2);
    }
    return text += pattern;
}

std::string fixed_text(double number, int digits) {
    char buffer[std::numeric_limits<double>::max_exponent10 + 64];
    LIMN_CHECK(digits >= 0 && digits < 32);
    const std::to_chars_result end =
        std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::fixed, digits);
    return std::string(buffer, end.ptr);
}

std::string align_right(const TextPart& part, std::size_t width) {
    const std::string text = align_left(part, 0);
    return std::string(text.size() < width ? width - text.size() : 0, ' ') + text;
}

std::string align_left(const TextPart& part, std::size_t width) {
    std::string text;
    part.append_to(text);
    text.resize(std::max(text.size(), width), ' ');
    return text;
}

}  // namespace limn
