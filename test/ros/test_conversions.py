"""Messages there and back: what is sent is what arrives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import pytest
from blocks_planning_msgs import msg as ros
from builders import ARCH, CHAIR, FRAME, NEVER_SOLVED, PLANNERS, planner_id, spec
from carried import BOARD, HUMAN, TOPIC_OF, said_in, sent
from hypothesis import given, settings
from hypothesis import strategies as st
from persons import Person
from strategies import boards, positions, solvable_tasks, tasks

from blocks_planning.board.blocks import Block, Placed, Placement
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.task import Task
from blocks_planning.families import Registry
from blocks_planning.ros.wire.conversions.cells import grid_from_ros, grid_to_ros
from blocks_planning.ros.wire.conversions.trial import code_of, spec_from_ros, spec_to_ros
from blocks_planning.ros.wire.topics import ACTION_OUTCOME, OUTCOME, STATE, TRIAL
from blocks_planning.search.searches import make_search
from blocks_planning.settings import Configured, Setting, setting, settings_for
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.registry import STRATEGIES, planner_names
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import (
    Held,
    Message,
    PlacementCode,
    PlacementOutcome,
    TrialEnded,
    TrialStarted,
    observed,
)
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import FAMILIES, TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.worlds.observation import Observation


def values_of(known: Setting) -> st.SearchStrategy[Any]:
    """The values that a setting allows, as far as a message can carry them."""
    words = known.choices or (tuple(known.family) if known.family is not None else ())
    if words:
        return st.sampled_from(words)
    if known.kind is bool:
        return st.booleans()
    if known.kind is str:
        return st.from_regex(known.pattern or r'\w{0,9}', fullmatch=True)
    if known.kind is int:
        return st.integers(int(known.least or 0), int(min(known.most or 999, 2**63 - 1)))
    least = known.least if known.least is not None else known.above or 0
    most = known.most if known.most is not None else 1000.0
    return st.floats(least, most, exclude_min=known.above is not None)


def members(registry: Registry) -> st.SearchStrategy[Any]:
    """Every member of a family, with any settings."""

    def of(name: str) -> st.SearchStrategy[Any]:
        known = settings_for(registry[name], {})
        values = {one.name: values_of(one) for one in known}
        return st.fixed_dictionaries({}, optional=values).map(lambda v: registry.make(name, v))

    return st.sampled_from(list(registry)).flatmap(of)


# What a text of a message can carry: it ends at a zero byte.
TEXTS = st.text(st.characters(codec='utf-8', exclude_characters='\0'), max_size=20)
SPECS = st.builds(
    lambda members, **parts: TrialSpec(**parts, **members),
    members=st.fixed_dictionaries({family: members(r) for family, r in FAMILIES.items()}),
    stimulus=TEXTS,
    task=tasks(),
    seed=st.integers(0, 2**64 - 1),
    budget=st.integers(0, 2**63 - 1),
)


def check_there_and_back(messages: list[Message], record: TrialRecord) -> set[type]:
    """See that all messages arrive as they were; return their types."""
    board = record.spec.task.board
    carried = [message for message in messages if type(message) in TOPIC_OF]
    for message in carried:
        topic = TOPIC_OF[type(message)]
        arrived = topic.from_ros(board, sent(topic.to_ros(board, message)))
        if isinstance(message, TrialEnded):  # the record stays with whoever wrote it
            assert message.record == record
            message = TrialEnded(message.trial_id, message.status, message.reason)
        assert arrived == message
    return {type(message) for message in carried}


@given(boards().flatmap(lambda b: st.tuples(st.just(b), st.integers(0, b.full))))
def test_grid_there_and_back(case: tuple[Board, Mask]) -> None:
    assert grid_from_ros(sent(grid_to_ros(*case)), 'grid') == case


def test_grid_is_row_major_from_the_ground() -> None:
    grid = grid_to_ros(Board(3, 2), Board(3, 2).parse(['..#', '##.']))
    assert (grid.width, grid.height, list(grid.cells)) == (3, 2, [1, 1, 0, 0, 0, 1])


@given(SPECS)
def test_trial_there_and_back(trial: TrialSpec) -> None:
    assert spec_from_ros(sent(spec_to_ros('', trial))) == trial
    started = TrialStarted('some run', trial)
    assert TRIAL.from_ros(None, sent(TRIAL.to_ros(None, started))) == started


def test_trial_can_be_changed_before_it_is_sent() -> None:
    """Other messages of the same cells and blocks stay what they are."""
    trial = TrialSpec(
        'x', spec(ARCH).task, NoSubgoals(), make_search('bfs', {}), built=(Placed(2, 1, 0, 0),)
    )
    message = spec_to_ros('', trial)
    message.silhouette.width = message.library[0].width = message.built[0].block.width = 0
    assert spec_from_ros(spec_to_ros('', trial)) == trial


def test_blocks_that_stand_at_the_beginning_there_and_back() -> None:
    built = (Placed(2, 1, 0, 0), Placed(1, 2, 0, 1))
    trial = TrialSpec('x', spec(ARCH).task, NoSubgoals(), make_search('bfs', {}), built=built)
    assert spec_from_ros(sent(spec_to_ros('', trial))) == trial
    check_there_and_back(*said_in(trial))


@dataclass(frozen=True)
class Timid(NoSubgoals):
    """A strategy with a setting of each type, which no code knows by name."""

    name: ClassVar[str] = 'timid'
    brave: bool = setting(True, 'Whether it dares.')
    steps: int = setting(3, 'How far it goes.', least=0, most=9)
    fear: float = setting(0.5, 'How much it fears.', least=0)
    word: str = setting('boo', 'What it says.')


def test_settings_of_a_strategy_that_is_added_travel_with_their_types() -> None:
    with STRATEGIES.added(Timid):
        timid = STRATEGIES.make('timid', {'brave': False, 'steps': 7, 'fear': 2.5, 'word': 'hm'})
        trial = TrialSpec('x', spec(ARCH).task, timid, make_search('bfs', {}))
        message = sent(spec_to_ros('', trial))
        kinds = {each.name: each.type for each in message.planner.strategy_settings}
        assert [kinds[name] for name in ('brave', 'steps', 'fear', 'word')] == [1, 2, 3, 4]
        assert spec_from_ros(message) == trial
        del message.planner.strategy_settings[list(kinds).index('steps')]  # it keeps its default
        assert spec_from_ros(message).strategy == Timid(brave=False, steps=3, fear=2.5, word='hm')
    assert issubclass(Timid, Configured)


@pytest.mark.parametrize('planner', PLANNERS, ids=planner_id)
@pytest.mark.parametrize('rows', [CHAIR, FRAME, NEVER_SOLVED])
def test_everything_said_in_a_trial_there_and_back(rows: str, planner: dict[str, Any]) -> None:
    check_there_and_back(*said_in(spec(rows, budget=300, seed=2, **planner)))


@pytest.mark.parametrize('name', planner_names())
def test_every_strategy_there_and_back(name: str) -> None:
    check_there_and_back(*said_in(spec(CHAIR, strategy=name, budget=300)))


def test_every_topic_carries_something_in_a_trial() -> None:
    messages, record = said_in(HUMAN)
    pauses = [Held(HUMAN.trial_id, until) for until in (0, 3, None)]
    assert check_there_and_back([*messages, *pauses], record) == set(TOPIC_OF)


@pytest.mark.parametrize('seed', range(5))
def test_what_a_person_says_there_and_back(seed: int) -> None:
    person = Person(HUMAN, seed)
    messages: list[Message] = []

    def observe(message: Message) -> None:
        person.observe(message)
        messages.append(message)

    record = run_trial(HUMAN, observe=observe, proposals=person)
    check_there_and_back(messages, record)


@settings(max_examples=20)
@given(
    st.one_of(solvable_tasks(16, 8), positions(16).map(lambda p: Task(p[0].board, p.built))),
    st.sampled_from(planner_names()),
)
def test_trials_on_any_board_there_and_back(task: Task, name: str) -> None:
    search = make_search('bfs', {'depth': 1})
    check_there_and_back(*said_in(TrialSpec('any', task, STRATEGIES[name](), search, 5, 500)))


# What happens in a world that does not obey

LOW, HIGH = Placed(2, 1, 0, 0), Placed(1, 2, 0, 1)
ORDER = Placement(Block(2, 1), 1)
HISTORIES = [
    (Observation(),),
    (Observation(landed=(LOW, HIGH)),),
    (Observation(), Observation(ORDER, (LOW,))),
    (Observation(), Observation(ORDER), Observation(ORDER, (LOW,))),
    (Observation(landed=(LOW, HIGH)), Observation(None, (), (HIGH,))),
    (Observation(landed=(LOW,)), Observation(ORDER, (Placed(2, 1, 1, 0),), (LOW,))),
]


@pytest.mark.parametrize('observations', HISTORIES, ids=str)
def test_state_with_any_history_there_and_back(observations: tuple[Observation, ...]) -> None:
    state = observed('x', BOARD, observations, TrialStatus.BUILDING)
    message = sent(STATE.to_ros(BOARD, state))
    assert STATE.from_ros(BOARD, message) == state
    assert message.sequence == len(observations) - 1


@pytest.mark.parametrize('code', PlacementCode)
@pytest.mark.parametrize('reason', ['', 'because'])
def test_outcome_of_an_order_there_and_back(code: PlacementCode, reason: str) -> None:
    landed = LOW if code in (PlacementCode.PLACED, PlacementCode.SLIPPED) else None
    outcome = PlacementOutcome('x', 3, landed, reason, code, 0.5)
    message = sent(ACTION_OUTCOME.to_ros(BOARD, outcome))
    assert ACTION_OUTCOME.from_ros(BOARD, message) == outcome
    assert message.reason
    assert getattr(ros.PlacementOutcome, f'CODE_{code.name}') == message.code


def test_every_end_has_a_code_and_a_sentence() -> None:
    record = said_in(spec(ARCH))[1]
    codes = set()
    ends: list[tuple[TrialStatus, str]] = [
        (status, '') for status in TrialStatus if status is not TrialStatus.BUILDING
    ]
    for status, reason in [*ends, (TrialStatus.CANCELLED, 'missing: world')]:
        ended = TrialEnded('x', status, reason, record)
        message = sent(OUTCOME.to_ros(None, ended))
        assert message.reason
        assert message.code == code_of(status, reason)
        assert OUTCOME.from_ros(None, message) == TrialEnded('x', status, reason)
        codes.add(message.code)
    assert len(codes) == len(ends) + 1


def test_outcome_has_the_whole_summary_of_the_record() -> None:
    record = said_in(spec(CHAIR, strategy='full', search='random', budget=300))[1]
    message = sent(OUTCOME.to_ros(None, TrialEnded('x', record.status, '', record)))
    assert {name: getattr(message, name) for name in record.summary()} == record.summary()
    assert message.sequence == len(record.observations) - 1
