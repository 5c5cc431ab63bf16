// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/app/speak_held_out.h"

#include "db/types/errors.h"
#include "db/types/sentence_key.h"
#include "synth/search/cost_weights.h"
#include "tools/app/synth_inputs.h"
#include "tools/app/workers.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <utility>

#include <fmt/format.h>

namespace phonomime {

namespace {

// The methods as made from one speaker's recordings.
struct Speaker {
  MeasureSetup setup;
  std::vector<std::unique_ptr<Method>> methods;
};

std::map<std::string, Speaker> make_speakers(const std::map<std::string, MotionTable>& tables,
                                             std::span<const MethodEntry> methods,
                                             const SynthOptions& options, std::size_t workers,
                                             const Progress& progress,
                                             const std::function<void(CostWeights&)>& change) {
  std::map<std::string, Speaker> speakers;
  std::int64_t made = 0;
  const auto total = static_cast<std::int64_t>(tables.size() * methods.size());
  for (const auto& [name, table] : tables) {
    MethodContext context{
        .table = table,
        .weights =
            read_weights(options, default_cost_weights(table, options.cost.value_or(kUsualCost))),
        .paper_weights = default_cost_weights(table, CostModel::paper),
        .blend = options.blend.value_or(kUsualBlend),
        .concat = concat_options(options),
        .threads = options.threads,
        .workers = workers};
    if (change) {
      change(context.weights);
      change(context.paper_weights);
    }
    Speaker& speaker = speakers[name];
    speaker.setup = {
        .layout = table.layout, .rate_hz = table.rate_hz, .reference_pose = table.reference_pose};
    for (const MethodEntry& method : methods) {
      progress.update(fmt::format("preparing {}", method.name), made++, total);
      speaker.methods.push_back(method.make(context, progress));
    }
  }
  return speakers;
}

SpokenSentence speak(const ImportedSentence& recorded, Speaker& speaker,
                     std::span<const MethodEntry> methods, std::size_t worker,
                     const Progress& progress) {
  SpokenSentence spoken;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const SentenceRequest request{.rows = recorded.rows,
                                  .emotion = recorded.emotion,
                                  .frame_count = recorded.channels.rows(),
                                  .recorded =
                                      methods[m].sees_recording ? &recorded.channels : nullptr};
    MethodAnswer answer = speaker.methods[m]->say(request, worker, progress);
    answer.sentence.method = methods[m].name;
    spoken.measures.push_back(
        measure_sentence(speaker.setup, recorded, answer.sentence.channels, answer.sentence.joins));
    spoken.search_s.push_back(answer.search_s);
    spoken.synthesised.push_back(std::move(answer.sentence));
  }
  return spoken;
}

// Whatever ends the work on one sentence, so that it can leave a worker.
std::exception_ptr failure_of(const ImportedSentence& sentence) {
  try {
    throw;
  } catch (const InputError& error) {
    return std::make_exception_ptr(
        InputError({.where = "sentence " + sentence_key(sentence), .what = error.what()}));
  } catch (...) {
    return std::current_exception();
  }
}

} // namespace

void speak_held_out(const std::map<std::string, MotionTable>& tables,
                    std::span<const ImportedSentence> sentences,
                    std::span<const MethodEntry> methods, const SynthOptions& options,
                    const Progress& progress,
                    const std::function<void(std::size_t sentence, SpokenSentence&&)>& take,
                    const std::function<void(CostWeights&)>& change) {
  const std::size_t workers =
      std::clamp<std::size_t>(sentences.size(), 1, worker_count(options.threads));
  std::map<std::string, Speaker> speakers =
      make_speakers(tables, methods, options, workers, progress, change);
  std::vector<std::exception_ptr> failures(sentences.size());
  std::atomic<bool> failed = false;
  std::mutex mutex;
  std::int64_t done = 0;
  const Progress only_stop{.report = {}, .stop = progress.stop};
  share_out(sentences.size(), workers, progress.stop, [&](std::size_t worker, std::size_t i) {
    if (failed) {
      return;
    }
    try {
      SpokenSentence spoken =
          speak(sentences[i], speakers.at(sentences[i].speaker), methods, worker, only_stop);
      const std::scoped_lock lock(mutex);
      take(i, std::move(spoken));
      ++done;
      if (progress.report) {
        progress.report("speaking", done, static_cast<std::int64_t>(sentences.size()));
      }
    } catch (...) {
      failures[i] = failure_of(sentences[i]);
      failed = true;
    }
  });
  for (const std::exception_ptr& failure : failures) {
    if (failure) {
      std::rethrow_exception(failure);
    }
  }
  progress.update("speaking", done, static_cast<std::int64_t>(sentences.size()));
}

} // namespace phonomime
