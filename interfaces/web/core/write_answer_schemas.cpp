// Writes the schemas of the core's answers; on the developer's machine, for scripts/make-web-types.
#include <cstdio>

#include "answers.hpp"

int main() { std::puts(wingbeat::web::answer_schemas().dump(1).c_str()); }
