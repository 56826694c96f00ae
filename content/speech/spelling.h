#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace limn {

/// One sound of an utterance.
struct Sound {
    std::uint8_t phoneme = 0;  ///< index into phonemes()
    bool stressed = false;     ///< of vowels
    bool ends_phrase = false;  ///< last sound before a pause
    bool starts_word = false;
};

/// The sounds of English text by letter-to-sound rules in the manner of H. Elovitz et al.,
/// "Automatic Translation of English Text to Phonetics by Means of Letter-to-Sound Rules", NRL
/// Report 7948, 1976, with the most frequent exceptions by word. Numbers up to 999,999 are read,
/// other digits one by one; punctuation becomes silence; letters beyond ASCII are skipped. Empty
/// for text without letters and digits. Every word has a sound: unknown ones by the rules.
[[nodiscard]] std::vector<Sound> sounds_of_text(std::string_view text);

/// The sounds of a transcription in the International Phonetic Alphabet, as `espeak-ng --ipa`
/// prints it; stress marks are read, unknown symbols are skipped. A line break is a pause.
[[nodiscard]] std::vector<Sound> sounds_of_ipa(std::string_view ipa);

}  // namespace limn
