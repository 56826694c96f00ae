#include "ecs/base/type_name.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace limn {

namespace {

constexpr bool is_upper(char c) {
    return c >= 'A' && c <= 'Z';
}
constexpr bool is_lower(char c) {
    return c >= 'a' && c <= 'z';
}
constexpr bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

}  // namespace

std::string snake_case(std::string_view name) {
    std::string snake;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        if (is_upper(c)) {
            // A word begins after a lower-case letter or digit, and at the last capital of an
            // acronym.
            const bool after_word = i > 0 && (is_lower(name[i - 1]) || is_digit(name[i - 1]));
            const bool ends_acronym =
                i > 0 && is_upper(name[i - 1]) && i + 1 < name.size() && is_lower(name[i + 1]);
            if (after_word || ends_acronym) {
                snake += '_';
            }
            snake += static_cast<char>(c - 'A' + 'a');
        } else if (is_lower(c) || is_digit(c)) {
            snake += c;
        } else if (!snake.empty() && snake.back() != '_') {
            snake += '_';
        }
    }
    while (!snake.empty() && snake.back() == '_') {
        snake.pop_back();
    }
    return snake;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    // Damerau-Levenshtein with adjacent transpositions (optimal string alignment), three rows.
    std::vector<std::size_t> before_last(b.size() + 1);
    std::vector<std::size_t> last(b.size() + 1);
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) {
        last[j] = j;
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, replace});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before_last[j - 2] + 1);
            }
        }
        std::swap(before_last, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

}  // namespace limn
