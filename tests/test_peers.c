// A separate general Taylor integrator (tests/bench/peers/taylor_peer.c), compared with
// the laboratory: the same impacts, pulses and forces. Keeps the peers that need no
// library compiling.
#include "tests/bench/peers/peer.h"
#include "tests/check.h"

static peer_answer answer_of(const peer *p)
{
    peer_answer answer;
    peer_answer_clear(&answer);
    void *instance = p->create(p);
    assert_non_null(instance);
    assert_true(p->run(instance, &answer));
    p->destroy(instance);
    return answer;
}

TEST(another_integrator_answers_the_same)
{
    const peer *ours, *others;
    peers_impactlab(&ours);
    assert_int_equal(peers_taylor(&others), 1);
    const peer_answer a = answer_of(&ours[0]), b = answer_of(&others[0]);
    check_close(b.first_contact, a.first_contact, 1e-12);
    check_close(b.impulse, a.impulse, 1e-13);
    check_close(b.peak, a.peak, 1e-11);
    check_close(b.peak_delay, a.peak_delay, 1e-9);
    check_close(b.release, a.release, 1e-11);
    check_close(b.second_contact, a.second_contact, 1e-11);
    check_close(b.final_force, a.final_force, 1e-10);
}
