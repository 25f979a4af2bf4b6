# The problems of NIST StRD, for the tests and the benchmark that solve them: compiled once.
if(NOT TARGET nist_problem)
  add_library(nist_problem STATIC ${CMAKE_CURRENT_LIST_DIR}/nist_problem.cpp)
  target_link_libraries(nist_problem PUBLIC locograph::solvers PRIVATE locograph_private_options)
endif()
