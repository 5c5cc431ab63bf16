// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/html_text.h"
#include "tools/evaluate/page_data.h"
#include "tools/evaluate/page_template.h"
#include "tools/evaluate/report.h"

#include <nlohmann/json.hpp>

namespace phonomime {

std::string evaluation_html(const Evaluation& evaluation, const std::vector<ShownSentence>& shown,
                            const std::optional<Comparison>& comparison) {
  const PageTemplate page = page_template();
  std::string filled(page.html);
  // From the last slot to the first: what is filled in may look like a slot.
  fill_slot(filled, "@PHONOMIME_SCRIPT@", page.script);
  fill_slot(filled, "@PHONOMIME_DATA@",
            script_safe(page_data(evaluation, shown, comparison).dump()));
  fill_slot(filled, "@PHONOMIME_STYLE@", page.style);
  fill_slot(filled, "@PHONOMIME_TITLE@", escape_html("Evaluation of " + evaluation.run.corpus));
  return filled;
}

} // namespace phonomime
