// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/errors.h"
#include "tools/cli/arguments.h"
#include "tools/cli/terminal.h"
#include "tools/cli/verbs.h"

#include <csignal>
#include <exception>
#include <new>
#include <string>
#include <type_traits>
#include <variant>

namespace phonomime {
namespace {

void run(const Arguments& arguments) {
  const Progress progress = terminal_progress(arguments.common.quiet);
  std::visit(
      [&](const auto& verb) {
        if constexpr (std::is_same_v<std::decay_t<decltype(verb)>, PrintArguments>) {
          print(verb.text);
        } else {
          run_verb(verb, arguments.common, progress);
        }
      },
      arguments.verb);
}

// The one place where errors are caught: a message on stderr, the class as exit status.
int run_and_report(int argc, const char* const* argv) {
  try {
    run(parse_arguments(argc, argv));
    return 0;
  } catch (const Error& error) {
    print_message(std::string("phonomime: ") + error.what());
    return static_cast<int>(error.error_class());
  } catch (const std::bad_alloc&) {
    print_message("phonomime: there is not enough memory for this");
  } catch (const std::exception& error) {
    print_message(std::string("phonomime: internal error: ") + error.what());
  }
  return static_cast<int>(ErrorClass::internal);
}

} // namespace
} // namespace phonomime

int main(int argc, char** argv) {
  // A closed pipe is an error of writing, with a message and a status, not a silent death.
  std::signal(SIGPIPE, SIG_IGN);
  return phonomime::run_and_report(argc, argv);
}
