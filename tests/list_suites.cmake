# Writes the ctest file of one test program: one test per suite, "PREFIX.Suite". Starting a program that links image
# and video libraries takes a third of a second, which for single tests is often more than they take themselves.
# Needs PROGRAM, PREFIX, COST, OUTPUT.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed RESULT_VARIABLE result TIMEOUT 60)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} cannot list its tests: ${result}")
endif()
string(REGEX MATCHALL "(^|\n)[^ \n]+\\." suites "${listed}")
set(text "")
foreach(suite ${suites})
  string(STRIP "${suite}" suite)
  string(REGEX REPLACE "\\.$" "" suite "${suite}")
  string(APPEND text "add_test([==[${PREFIX}.${suite}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${suite}.*]==])\n"
                     "set_tests_properties([==[${PREFIX}.${suite}]==] PROPERTIES TIMEOUT 1800 COST ${COST})\n")
endforeach()
file(WRITE ${OUTPUT} "${text}")
