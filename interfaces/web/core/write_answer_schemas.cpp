// Writes the schemas of what both libraries answer; on the developer's machine, for scripts/describe-results.
#include <cstdio>

#include "answers.hpp"
#include "flown.hpp"

int main() {
  wingbeat::web::Json schemas = wingbeat::web::answer_schemas();
  schemas.update(wingbeat::web::flight_schemas());
  std::puts(schemas.dump(1).c_str());
}
