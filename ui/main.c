// impactlab: the program, which is all in the library that tests use, too.
#include "ui/commands/command.h"

int main(int argc, char **argv)
{
    return program_run(argc, argv);
}
