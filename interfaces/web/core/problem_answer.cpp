#include "answers.hpp"
#include "report/described.hpp"

namespace wingbeat::web {
namespace {

const described::Description<Problem>& problem_description() {
  static const described::Description<Problem> description =
      described::Description<Problem>()
          .always("message", "", "a sentence", &Problem::message)
          .sometimes("key", "", "", &Problem::key)
          .sometimes("line", "", "0: of the input as a whole", &Problem::line)
          .sometimes("column", "", "", &Problem::column);
  return description;
}

}  // namespace

Json problem_answer(const Problem& problem) { return problem_description().json(problem); }
Json problem_schema() { return problem_description().schema(); }

}  // namespace wingbeat::web
