# Run at every build: writes POSTFX_COMMIT, the commit that the sources are of, into HEADER, touching it only when it
# is another. SOURCE: the tree; without git, or outside of a checkout, it is "commit unknown".
find_package(Git QUIET)
set(commit "")
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
                  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(commit)
  string(REPLACE "-dirty" " with changes" commit "commit ${commit}")
else()
  set(commit "commit unknown")
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#pragma once\n#define POSTFX_COMMIT \"${commit}\"\n" @ONLY)
