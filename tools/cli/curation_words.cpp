// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/call_words.h"

#include "tools/cli/words.h"

#include <CLI/CLI.hpp>

namespace phonomime {

namespace {

// Which nodes a verb is about. `pruned` is no choice of verbs that prune or restore.
void add_node_filter(CLI::App* verb, CurationWords& words) {
  NodeFilter& filter = words.filter;
  const auto add = [&](const char* name, std::string& text, const char* meaning) {
    verb->add_option(name, text, meaning)->type_name("NAME");
  };
  add("--phoneme", filter.phoneme, "Only this phoneme");
  add("--emotion", filter.emotion, "Only this emotion");
  add("--speaker", filter.speaker, "Only this speaker");
  add("--sentence", filter.sentence, "Only this sentence (its id)");
  add("--previous", filter.previous_phoneme, "Only after this phoneme (pau is silence)");
  add("--next", filter.next_phoneme, "Only before this phoneme (pau is silence)");
}

void add_suspect_filters(CLI::App* verb, CurationWords& words) {
  verb->add_flag("--suspect", words.only_suspect,
                 "Only suspects: whatever reason `phonomime suspects` tells");
  verb->add_flag("--gaps", words.only_gaps, "Only those with unfilled gaps");
}

void add_suspects(CLI::App& app, CurationWords& words) {
  SuspectsOptions& options = words.suspects.options;
  CLI::App* verb =
      app.add_subcommand("suspects", "Motion nodes that may be contaminated, worst first");
  verb->footer("Example:\n  phonomime suspects ann.db --reason swapped --limit 20\n"
               "  phonomime suspects ann.db --reason swapped --keys |\n"
               "      phonomime prune ann.db --from - --reason \"swapped lip markers\"\n\n"
               "docs/curation.md says what is looked for and how scores are made.");
  add_database(verb, options.database, false);
  add_node_filter(verb, words);
  verb->add_option("--reason", options.reason,
                   "Only this reason: gap, frozen, swapped, jump, drift, neighbours, pose or "
                   "duration")
      ->type_name("REASON");
  verb->add_flag("--pruned", options.with_pruned, "Also those that are out of use already");
  verb->add_flag("--judge", options.judge,
                 "First judge the stored motion anew, and keep what is found (an import does that "
                 "too)");
  verb->add_option("--limit", words.limit, "At most this many (default: all)")->type_name("N");
  CLI::Option* csv = verb->add_flag("--csv", words.csv, "One line a mark, comma separated");
  verb->add_flag("--keys", words.keys_alone, "Nothing but keys, one a line")->excludes(csv);
  verb->add_option("--threads", options.threads,
                   "Threads that --judge works with (default: one for each core)")
      ->type_name("N");
}

// What prune, restore and undo have in common.
void add_act(CLI::App* verb, CurationWords& words) {
  CurateOptions& options = words.curate.options;
  verb->add_option("--by", options.by, "Whose name the journal keeps (default: the user's)")
      ->type_name("NAME");
  verb->add_option("--thin", options.thin_below,
                   "Phonemes, emotions and triphones with fewer nodes than this are told of")
      ->type_name("N")
      ->capture_default_str();
  verb->add_flag("--dry-run", options.dry_run, "Tell what would be done, and change nothing");
}

void add_choice(CLI::App* verb, CurationWords& words, const char* reason) {
  CurateOptions& options = words.curate.options;
  add_database(verb, options.database, false);
  verb->add_option("keys", options.keys, "Motion nodes, by their keys")->type_name("KEY...");
  verb->add_option("--from", options.from,
                   "Also the nodes of a file: a key on each line, or what `nodes` or `suspects` "
                   "prints; - is standard input")
      ->type_name("FILE");
  add_node_filter(verb, words);
  add_suspect_filters(verb, words);
  verb->add_option("--reason", options.reason, reason)->required()->type_name("WHY");
  add_act(verb, words);
}

} // namespace

void add_nodes(CLI::App& app, CallWords& words) {
  CLI::App* verb =
      app.add_subcommand("nodes", "List motion nodes: the recorded phonemes of a database");
  verb->footer("Example:\n  phonomime nodes ann.db --phoneme aa --emotion happiness --limit 10\n\n"
               "A node is listed where all of the options hold for it.");
  add_database(verb, words.nodes.database, false);
  add_node_filter(verb, words.curation);
  add_suspect_filters(verb, words.curation);
  verb->add_flag("--pruned", words.curation.only_pruned, "Only those that were taken out of use");
  verb->add_option("--limit", words.curation.limit, "At most this many (default: all)")
      ->type_name("N");
}

void add_curation(CLI::App& app, CallWords& words) {
  add_suspects(app, words.curation);
  CLI::App* prune = app.add_subcommand("prune", "Take motion nodes out of use");
  prune->footer(
      "Example:\n  phonomime prune ann.db bbaf2n#5 bbaf2n#6 --reason \"lip marker lost\"\n\n"
      "Nothing is deleted: `restore` and `undo` bring nodes back, and `journal`\n"
      "lists what was done. Options choose nodes for which all of them hold.");
  add_choice(prune, words.curation, "Why; the journal keeps it");
  CLI::App* restore = app.add_subcommand("restore", "Bring pruned motion nodes back into use");
  restore->footer(
      "Example:\n  phonomime restore ann.db bbaf2n#5 --reason \"looks fine after all\"");
  add_choice(restore, words.curation, "Why; the journal keeps it");
  CLI::App* undo = app.add_subcommand("undo", "Take back the last prune or restore");
  undo->footer("Example:\n  phonomime undo ann.db\n\n"
               "Once more takes back the one before.");
  add_database(undo, words.curation.curate.options.database, false);
  undo->add_option("--reason", words.curation.curate.options.reason, "Why; the journal keeps it")
      ->type_name("WHY");
  add_act(undo, words.curation);
  CLI::App* journal = app.add_subcommand("journal", "What was pruned, restored and undone");
  journal->footer("Example:\n  phonomime journal ann.db");
  add_database(journal, words.curation.journal.database, false);
}

bool take_curation_words(const CLI::App& verb, CallWords& words) {
  CurationWords& from = words.curation;
  check_limit(from.limit);
  const auto only_if = [](bool flag) { return flag ? std::optional(true) : std::nullopt; };
  const std::string name = verb.get_name();
  if (name == "nodes") {
    words.nodes.filter = from.filter;
    words.nodes.filter.suspect = only_if(from.only_suspect);
    words.nodes.filter.pruned = only_if(from.only_pruned);
    words.nodes.filter.has_gap = only_if(from.only_gaps);
    words.nodes.limit = from.limit;
    words.arguments.verb = words.nodes;
  } else if (name == "suspects") {
    from.suspects.options.filter = from.filter;
    from.suspects.options.limit = static_cast<std::size_t>(from.limit);
    from.suspects.form = from.csv          ? SuspectsForm::csv
                         : from.keys_alone ? SuspectsForm::keys
                                           : SuspectsForm::text;
    words.arguments.verb = from.suspects;
  } else if (name == "prune" || name == "restore" || name == "undo") {
    CurateOptions& options = from.curate.options;
    options.action = name == "prune"     ? CurationAction::prune
                     : name == "restore" ? CurationAction::restore
                                         : CurationAction::undo;
    const NodeFilter& filter = from.filter;
    const bool chooses = from.only_suspect || from.only_gaps || !filter.phoneme.empty() ||
                         !filter.emotion.empty() || !filter.speaker.empty() ||
                         !filter.sentence.empty() || !filter.previous_phoneme.empty() ||
                         !filter.next_phoneme.empty();
    if (chooses) {
      options.filter = filter;
      options.filter->suspect = only_if(from.only_suspect);
      options.filter->has_gap = only_if(from.only_gaps);
    }
    words.arguments.verb = from.curate;
  } else if (name == "journal") {
    words.arguments.verb = from.journal;
  } else {
    return false;
  }
  return true;
}

} // namespace phonomime
