// Why a run comes out as it does: a causal account in at most five sentences, made from
// its events and energies.
#pragma once

#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

enum { ACCOUNT_SENTENCES = 5, ACCOUNT_SENTENCE = 320 };

// Writes the account of a run with its rows; `s` is the scenario that was run. Returns
// how many sentences there are, at least one.
int run_account(const scenario *s, const run_result *run,
                char sentences[ACCOUNT_SENTENCES][ACCOUNT_SENTENCE]);

// The same in half a sentence of a few words, for a line beside its numbers: how fast the
// arm hits, and how much of its motion the impact takes at once.
void run_account_line(const run_result *run, char line[ACCOUNT_SENTENCE]);
