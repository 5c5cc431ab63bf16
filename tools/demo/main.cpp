// SPDX-License-Identifier: GPL-3.0-or-later
#include <exception>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>

#include "db/types/errors.h"
#include "db/types/file_io.h"
#include "db/types/text.h"
#include "tools/demo/corpus_writer.h"

namespace {

using namespace phonomime;

constexpr std::string_view kHelp =
    R"(usage: phonomime_demo_corpus --sentences FILE --speech DIR --out DIR [--face OBJ] [--seed N]

Makes the synthetic demo corpus from speech that Festival has spoken and timed.

  --sentences FILE  lines of id, tab, text
  --speech DIR      <emotion>/<id>.wav and <emotion>/<id>.lab for neutral, happiness, anger, sadness
  --out DIR         corpus folder to make; an earlier demo corpus there is replaced
  --face OBJ        the canonical face mesh; without it a mask made of the markers is used
  --seed N          of all random choices (default 2008)

example: phonomime_demo_corpus --sentences tools/demo/sentences.txt --speech speech --out out/demo
)";

[[noreturn]] void refuse(std::string what) {
  throw UsageError({.what = std::move(what), .remedy = "See phonomime_demo_corpus --help."});
}

demo::CorpusJob parse_job(int argc, char** argv) {
  demo::CorpusJob job;
  std::string sentences;
  std::string face;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view option = argv[i];
    if (i + 1 == argc)
      refuse("option " + quoted(option) + " has no value");
    const std::string_view value = argv[i + 1];
    if (option == "--sentences") {
      sentences = value;
    } else if (option == "--speech") {
      job.speech = value;
    } else if (option == "--out") {
      job.out = value;
    } else if (option == "--face") {
      face = value;
    } else if (option == "--seed") {
      const std::optional<long> seed = parse_integer(value);
      if (!seed || *seed < 0)
        refuse("--seed takes an integer of 0 or more, not " + quoted(value));
      job.seed = static_cast<std::uint64_t>(*seed);
    } else {
      refuse("there is no option " + quoted(option));
    }
  }
  if (sentences.empty() || job.speech.empty() || job.out.empty())
    refuse("--sentences, --speech and --out are needed");
  job.sentences = demo::parse_sentences(read_file(sentences), sentences);
  job.face =
      face.empty() ? demo::mask_face_model() : demo::canonical_face_model(read_file(face), face);
  return job;
}

} // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "--help") {
    std::cout << kHelp;
    return 0;
  }
  try {
    const demo::CorpusJob job = parse_job(argc, argv);
    const demo::CorpusReport report = demo::write_corpus(job);
    std::cerr << "synthetic demo corpus: " << report.sentences << " sentences, " << report.frames
              << " frames, " << report.contaminated << " contaminated, " << report.with_dropouts
              << " with drop-outs: " << job.out.string() << "\n";
    return 0;
  } catch (const Error& error) {
    std::cerr << "phonomime_demo_corpus: " << error.what() << "\n";
    return static_cast<int>(error.error_class());
  } catch (const std::exception& error) {
    std::cerr << "phonomime_demo_corpus: internal error: " << error.what() << "\n";
    return static_cast<int>(ErrorClass::internal);
  }
}
