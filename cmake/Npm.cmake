# SPDX-License-Identifier: GPL-3.0-or-later

# phonomime_npm(TARGET FOLDER COMMENT text [FILES script.mjs ...]): a target that has the packages of
# package.json beside the calling CMakeLists.txt, as its lock file pins them, installed in FOLDER of
# the build tree (the source tree stays clean), and FILES copied to where they find them. Commands may
# depend on FOLDER/npm.stamp. Needs PHONOMIME_NPM (synth/export/player).
function(phonomime_npm target folder)
  cmake_parse_arguments(ARG "" "COMMENT" "FILES" ${ARGN})
  set(packages package.json package-lock.json .npmrc)
  list(TRANSFORM packages PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  add_custom_command(
    OUTPUT ${folder}/npm.stamp
    COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
    COMMAND ${CMAKE_COMMAND} -E copy ${packages} ${folder}
    COMMAND ${PHONOMIME_NPM} ci --prefix ${folder} --no-audit --no-fund --loglevel=error
    COMMAND ${CMAKE_COMMAND} -E touch ${folder}/npm.stamp
    DEPENDS ${packages}
    COMMENT "${ARG_COMMENT}"
    VERBATIM)
  set(copies)
  foreach(file IN LISTS ARG_FILES)
    add_custom_command(
      OUTPUT ${folder}/${file}
      COMMAND ${CMAKE_COMMAND} -E copy ${CMAKE_CURRENT_SOURCE_DIR}/${file} ${folder}
      DEPENDS ${file} ${folder}/npm.stamp
      VERBATIM)
    list(APPEND copies ${folder}/${file})
  endforeach()
  add_custom_target(${target} DEPENDS ${folder}/npm.stamp ${copies})
endfunction()
