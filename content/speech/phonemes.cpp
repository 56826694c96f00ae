#include "content/speech/phonemes.h"

#include <algorithm>
#include <array>

// Techniques: face.viseme

namespace limn {

namespace {

constexpr std::array kPhonemes{
    Phoneme{"sil", "", Viseme::Silence, 0.2f},
    Phoneme{"p", " p ", Viseme::P, 0.085f},
    Phoneme{"b", " b ", Viseme::P, 0.075f},
    Phoneme{"m", " m m̩ ", Viseme::P, 0.07f},
    Phoneme{"f", " f ", Viseme::F, 0.1f},
    Phoneme{"v", " v ", Viseme::F, 0.06f},
    Phoneme{"th", " θ ", Viseme::Th, 0.09f},
    Phoneme{"dh", " ð ", Viseme::Th, 0.05f},
    Phoneme{"t", " t ɾ ʔ ", Viseme::T, 0.075f},
    Phoneme{"d", " d ", Viseme::T, 0.065f},
    Phoneme{"k", " k x ", Viseme::K, 0.085f},
    Phoneme{"g", " g ɡ ", Viseme::K, 0.07f},
    Phoneme{"ng", " ŋ ", Viseme::K, 0.07f},
    Phoneme{"ch", " tʃ ", Viseme::Ch, 0.12f},
    Phoneme{"jh", " dʒ ", Viseme::Ch, 0.1f},
    Phoneme{"sh", " ʃ ", Viseme::Ch, 0.11f},
    Phoneme{"zh", " ʒ ", Viseme::Ch, 0.07f},
    Phoneme{"s", " s ", Viseme::S, 0.11f},
    Phoneme{"z", " z ", Viseme::S, 0.075f},
    Phoneme{"n", " n n̩ ", Viseme::N, 0.06f},
    Phoneme{"l", " l ɫ l̩ ", Viseme::N, 0.06f},
    Phoneme{"r", " ɹ r ", Viseme::R, 0.06f},
    Phoneme{"hh", " h ", Viseme::Silence, 0.05f},
    Phoneme{"w", " w ʍ ", Viseme::U, 0.06f},
    Phoneme{"y", " j ", Viseme::I, 0.055f},
    Phoneme{"aa", " ɑ ɑː aː ", Viseme::A, 0.13f, true},
    Phoneme{"ae", " æ a ", Viseme::A, 0.12f, true},
    Phoneme{"ah", " ʌ ɐ ", Viseme::A, 0.09f, true},
    Phoneme{"ax", " ə ᵻ ", Viseme::E, 0.05f, true},
    Phoneme{"eh", " ɛ e ", Viseme::E, 0.09f, true},
    Phoneme{"er", " ɜː ɚ ɜ ɝ ", Viseme::R, 0.13f, true},
    Phoneme{"ih", " ɪ ", Viseme::I, 0.07f, true},
    Phoneme{"iy", " iː i ", Viseme::I, 0.11f, true},
    Phoneme{"ao", " ɔː ɔ ɒ o oː ", Viseme::O, 0.13f, true},
    Phoneme{"uh", " ʊ ", Viseme::U, 0.07f, true},
    Phoneme{"uw", " uː u ", Viseme::U, 0.12f, true},
};

}  // namespace

std::span<const Phoneme> phonemes() {
    return kPhonemes;
}

int find_phoneme(std::string_view name) {
    const auto found = std::ranges::find(kPhonemes, name, &Phoneme::name);
    return found == kPhonemes.end() ? -1 : static_cast<int>(found - kPhonemes.begin());
}

}  // namespace limn
