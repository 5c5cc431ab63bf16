# SPDX-License-Identifier: GPL-3.0-or-later
# The page of the HTML report: page_template.cpp holds page/ as it is.
set(page_folder ${CMAKE_CURRENT_SOURCE_DIR}/page)
set(page_files ${page_folder}/report.html ${page_folder}/report.css)
set(page_scripts "")
foreach(name basics axes methods runs motion player sentence breakdowns main)
  list(APPEND page_files ${page_folder}/${name}.js)
  string(APPEND page_scripts "        \".incbin \\\"${page_folder}/${name}.js\\\"\\n\"\n")
endforeach()
set(report_page ${CMAKE_CURRENT_BINARY_DIR}/page_template.cpp)
configure_file(page_template.cpp.in ${report_page} @ONLY)
set_source_files_properties(${report_page} PROPERTIES OBJECT_DEPENDS "${page_files}")
