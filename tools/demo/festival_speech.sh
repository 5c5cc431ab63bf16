# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by make_demo_corpus and speak: how Festival is asked to speak and time a text.

voice=cmu_us_slt_arctic_hts

fail() { # STATUS MESSAGE
  printf '%s: %s\n' "${0##*/}" "$2" >&2
  exit "$1"
}

# Exits with status 4 and what to install where Festival or its voice is missing.
require_festival() {
  command -v festival >/dev/null 2>&1 ||
    fail 4 "Festival is missing. Install it: apt-get install festival festlex-cmu festvox-us-slt-hts"
  festival -b '(print (voice.list))' 2>/dev/null | grep -q "$voice" ||
    fail 4 "Festival has no voice $voice. Install it: apt-get install festlex-cmu festvox-us-slt-hts"
}

# Bytes as a Scheme string: backslash and quote escaped, blanks for control characters. Nothing of
# them is ever evaluated.
scheme_string() { # BYTES
  printf '"%s"' "$(printf '%s' "$1" | LC_ALL=C tr '\000-\037\177' ' ' |
    LC_ALL=C sed -e 's/\\/\\\\/g' -e 's/"/\\"/g')"
}

# A text in the ASCII that Festival reads: typographic quotes made plain, accents dropped.
plain_text() { # TEXT
  printf '%s' "$1" | LC_ALL=C.UTF-8 iconv -f UTF-8 -t ASCII//TRANSLIT ||
    fail 3 "the text is not UTF-8"
}

# The Scheme that loads the voice. RATE is a factor on its tempo, HALF_TONES shifts its pitch (the
# HTS voice takes its times from its own models and does not heed Duration_Stretch).
scheme_header() { # RATE HALF_TONES
  cat <<SCHEME
(voice_$voice)
(set! hts_engine_params
  (append ${voice}::hts_engine_params (list (list "-r" $1) (list "-fm" $2))))
(define (speak_to text wave segments)
  (let ((utterance (eval (list 'Utterance 'Text text))))
    (utt.synth utterance)
    (utt.save.wave utterance wave 'riff)
    (utt.save.segs utterance segments)))
SCHEME
}

# The Scheme that speaks TEXT (ASCII) into PREFIX.wav and PREFIX.lab.
scheme_speak() { # TEXT PREFIX
  printf '(speak_to %s %s %s)\n' "$(scheme_string "$1")" "$(scheme_string "$2.wav")" \
    "$(scheme_string "$2.lab")"
}
