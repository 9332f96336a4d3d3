# cmake -D BUILD=<build folder> -D SOURCE=<source root> -D WORK=<scratch folder> -P install_and_consume.cmake
# Installs a build into a prefix, builds the README's API example against the installed package, and runs the example
# and the installed program.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  message("${output}")
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed (${result}): ${ARGN}")
  endif()
endfunction()

# The code block between two marker lines of a text, without its fence.
function(cut_out text marker result)
  string(FIND "${text}" "<!-- ${marker} -->\n```cpp\n" begin)
  string(FIND "${text}" "```\n<!-- end of ${marker} -->" end)
  if(begin EQUAL -1 OR end LESS begin)
    message(FATAL_ERROR "README.md has no code between <!-- ${marker} --> and <!-- end of ${marker} -->")
  endif()
  string(LENGTH "<!-- ${marker} -->\n```cpp\n" fence)
  math(EXPR begin "${begin} + ${fence}")
  math(EXPR length "${end} - ${begin}")
  string(SUBSTRING "${text}" ${begin} ${length} block)
  set(${result} "${block}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
file(READ ${SOURCE}/README.md readme)
cut_out("${readme}" "api example" example)
file(WRITE ${WORK}/example.cpp "${example}")
file(WRITE ${WORK}/tetrahedron.obj "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -G Ninja -S ${SOURCE}/tests/house/consumer -B ${WORK}/build -D EXAMPLE_SOURCE=${WORK}/example.cpp
    -D CMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/example ${WORK}/tetrahedron.obj ${WORK}/example.ramcdb)
run(${WORK}/prefix/bin/ramcdb verify ${WORK}/example.ramcdb)

# The loop that the README shows, pasted.
if(EXISTS /usr/share/glmark2/models/bunny.obj)
  string(REGEX MATCHALL "\n    ramcdb [^\n]*" loop "${readme}")
  list(JOIN loop "" loop)
  file(WRITE ${WORK}/loop.sh "set -eux\ncd ${WORK}${loop}\n")
  run(${CMAKE_COMMAND} -E env PATH=${WORK}/prefix/bin:$ENV{PATH} bash ${WORK}/loop.sh)
else()
  message("skipped: the README's loop, since glmark2-data is not installed")
endif()
file(REMOVE_RECURSE ${WORK})
