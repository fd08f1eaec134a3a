"""Messages there and back, and the refusal of everything that a message can't say."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Iterator
from copy import deepcopy
from functools import cache
from typing import Any, NamedTuple

import pytest
from blocks_planning_msgs import msg as ros
from builders import CHAIR, FRAME, NEVER_SOLVED, PLANNERS, planner_id, spec
from hypothesis import given, settings
from hypothesis import strategies as st
from persons import Person, human_spec, rows_of
from rclpy.serialization import deserialize_message, serialize_message
from strategies import boards, positions, solvable_tasks, tasks

from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.task import Task
from blocks_planning.ros.wire.conversions.cells import grid_from_ros, grid_to_ros
from blocks_planning.ros.wire.conversions.fields import MAX_COST, MessageError
from blocks_planning.ros.wire.conversions.trial import (
    outcome_to_ros,
    spec_from_ros,
    spec_to_ros,
    started_from_ros,
)
from blocks_planning.ros.wire.topics import OUTCOME, STATE, SUBGOAL, TOPICS, TRIAL, Topic
from blocks_planning.search.searches import make_search
from blocks_planning.subgoals.human import COSTS, Human
from blocks_planning.subgoals.registry import make_strategy
from blocks_planning.trials import scribe, searcher, selector, world
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import (
    CancelTrial,
    Message,
    ProposalMade,
    SubgoalChosen,
    TrialStarted,
)
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec

TOPIC_OF = {topic.kind: topic for topic in TOPICS}
PARTS = (world, selector, searcher, scribe)
SPEC = spec(CHAIR, lam=0.2, depth=2)
HUMAN = human_spec(CHAIR, depth=2)
SAID_BY_PERSON = rows_of(HUMAN, 2, 4, 6)
BOARD = SPEC.task.board

STRATEGIES = st.one_of(
    st.just(make_strategy('none', {})),
    st.builds(
        lambda lam, commit: make_strategy('scoping', {'lambda': lam, 'commit': commit}),
        st.floats(0, 1000),
        st.sampled_from(['subgoal', 'action']),
    ),
    st.builds(lambda lam: make_strategy('full', {'lambda': lam}), st.floats(0.001, 1000)),
)
PEOPLE = st.builds(
    Human, st.from_regex(r'[A-Za-z0-9_-]{0,32}', fullmatch=True), st.sampled_from(COSTS)
)
EXECUTE = st.sampled_from(['first', 'path'])
SEARCHES = st.one_of(
    st.builds(lambda name: make_search(name, {}), st.sampled_from(['random', 'exact'])),
    st.builds(lambda depth: make_search('bfs', {'depth': depth}), st.integers(1, 64)),
    st.builds(
        lambda iterations, execute: make_search(
            'best_first', {'iterations': iterations, 'execute': execute}
        ),
        st.integers(2, 10**6),
        EXECUTE,
    ),
    st.builds(
        lambda iterations, execute, divisor: make_search(
            'astar', {'iterations': iterations, 'execute': execute, 'divisor': divisor}
        ),
        st.integers(2, 10**6),
        EXECUTE,
        st.sampled_from(['smallest', 'mean', 'largest']),
    ),
)
# What a text of a message can carry: it ends at a zero byte.
TEXTS = st.text(st.characters(codec='utf-8', exclude_characters='\0'), max_size=20)
SPECS = st.builds(
    TrialSpec,
    stimulus=TEXTS,
    task=tasks(),
    strategy=st.one_of(STRATEGIES, PEOPLE),
    search=SEARCHES,
    seed=st.integers(0, 2**64 - 1),
    budget=st.integers(0, 2**63 - 1),
)


def sent(message: Any) -> Any:
    """What arrives when a message is sent."""
    return deserialize_message(serialize_message(message), type(message))


def said_in(trial: TrialSpec) -> tuple[list[Message], TrialRecord]:
    """Everything that is said in a trial, and its record."""
    messages: list[Message] = []
    proposals = SAID_BY_PERSON if trial == HUMAN else ()
    record = run_trial(trial, observe=messages.append, proposals=proposals)
    return messages, record


def to_ros(board: Board, message: Any, record: TrialRecord) -> Any:
    """A message as the graph carries it."""
    topic = TOPIC_OF[type(message)]
    if topic is OUTCOME:
        return topic.to_ros(message.trial_id, record)
    return topic.to_ros(message) if topic is TRIAL else topic.to_ros(board, message)


def from_ros(board: Board, topic: Topic, message: Any) -> Any:
    """What a message of the graph says."""
    return topic.from_ros(board, message) if topic.needs_board else topic.from_ros(message)


def check_all_there_and_back(trial: TrialSpec) -> set[type]:
    return check_there_and_back(*said_in(trial))


def check_there_and_back(messages: list[Message], record: TrialRecord) -> set[type]:
    board = record.spec.task.board
    carried = [message for message in messages if type(message) in TOPIC_OF]
    for message in carried:
        arrived = sent(to_ros(board, message, record))
        assert from_ros(board, TOPIC_OF[type(message)], arrived) == message
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
    assert started_from_ros(sent(TRIAL.to_ros(started))) == started


@pytest.mark.parametrize('planner', PLANNERS, ids=planner_id)
@pytest.mark.parametrize('rows', [CHAIR, FRAME])
def test_everything_said_in_a_trial_there_and_back(rows: str, planner: dict[str, Any]) -> None:
    check_all_there_and_back(spec(rows, budget=300, seed=2, **planner))


def test_every_topic_has_its_say_in_a_trial() -> None:
    assert check_all_there_and_back(HUMAN) == set(TOPIC_OF)


@pytest.mark.parametrize('seed', range(5))
def test_what_a_person_says_there_and_back(seed: int) -> None:
    person = Person(HUMAN, seed)
    messages: list[Message] = []

    def observe(message: Message) -> None:
        person.observe(message)
        messages.append(message)

    record = run_trial(HUMAN, observe=observe, proposals=person)
    check_there_and_back(messages, record)


@pytest.mark.parametrize('planner', PLANNERS, ids=planner_id)
def test_giving_up_there_and_back(planner: dict[str, Any]) -> None:
    check_all_there_and_back(spec(NEVER_SOLVED, budget=300, **planner))


@settings(max_examples=40)
@given(
    st.one_of(solvable_tasks(16, 8), positions(16).map(lambda p: Task(p[0].board, p.built))),
    STRATEGIES,
)
def test_trials_on_any_board_there_and_back(task: Task, strategy: Any) -> None:
    check_all_there_and_back(
        TrialSpec('any', task, strategy, make_search('bfs', {'depth': 1}), 5, 500)
    )


class Change(NamedTuple):
    """A value put in the place of another, somewhere in a message."""

    topic: Topic
    path: str
    value: Any
    message: Any
    field: str


@cache
def examples() -> dict[str, Any]:
    """The longest message of each topic that is said in a trial, by the name of the topic."""
    messages, record = said_in(SPEC)
    messages += [message for message in said_in(HUMAN)[0] if isinstance(message, ProposalMade)]
    longest: dict[str, Any] = {}
    for message in messages:
        topic = TOPIC_OF.get(type(message))
        if topic is not None:
            carried = to_ros(BOARD, message, record)
            before = longest.get(topic.name)
            if before is None or len(serialize_message(before)) < len(serialize_message(carried)):
                longest[topic.name] = carried
    return longest


def example(topic: Topic) -> Any:
    """A copy of a real message."""
    return deepcopy(examples()[topic.name])


_WHOLE = {'uint8': 8, 'uint32': 32, 'uint64': 64}
_WORDS = ['', 'nonsense', 'BFS', 'bfs ', 'success', 'cancelled', 'ü' * 200]
_FLOATS = [float('nan'), float('inf'), float('-inf'), -1.0, 0.0, 1e308, 5e-324]


def values_of(kind: str) -> list[Any]:
    """Values to try in a field, all of which a message can carry."""
    if kind in _WHOLE:
        bits = _WHOLE[kind]
        return [0, 1, 2, 5, 16, 17, 127, 2 ** (bits - 1), 2**bits - 1]
    others: dict[str, list[Any]] = {
        'int32': [-(2**31), -2, -1, 0, 1, 2**31 - 1],
        'boolean': [False, True],
        'string': _WORDS,
        'double': _FLOATS,
        'sequence<uint8>': [b'', b'\0', b'\2', b'\1' * 3, b'\1' * 300, bytes(range(256))],
    }
    return others[kind]


def fields(message: Any, path: str = '') -> Iterator[tuple[Any, str, str, str]]:
    """Every plain field at any depth: its owner, its name, its type, its path."""
    for name, kind in message.get_fields_and_field_types().items():
        here = f'{path}{name}'
        value = getattr(message, name)
        if name in ('header', 'reason', 'stimulus', 'trial_id'):
            continue  # anything goes, or PartNode looks at it
        if kind.startswith('sequence<') and '/' in kind:
            for index, item in enumerate(value):
                yield from fields(item, f'{here}[{index}].')
            yield message, name, kind, here
        elif '/' in kind:
            yield from fields(value, f'{here}.')
        else:
            yield message, name, kind, here


def changed_lists(value: list[Any]) -> list[list[Any]]:
    """Lists that lack something, have too much, or are in another order."""
    return [[], value[:-1], value[1:], value[::-1], value * 2, value * 40]


def changes(topic: Topic) -> Iterator[Change]:
    """A real message with one field changed, for every field and many values."""
    for index in range(len(list(fields(example(topic))))):
        _, name, kind, _ = list(fields(example(topic)))[index]
        owner = list(fields(example(topic)))[index][0]
        tried = values_of(kind) if '/' not in kind else changed_lists(getattr(owner, name))
        for value in tried:
            message = example(topic)
            target, name, _, path = list(fields(message))[index]
            setattr(target, name, deepcopy(value))
            yield Change(topic, path, value, message, name)


def judge(change: Change) -> Any:
    """What a changed message says; None if it is refused, in which case it must be well said."""
    arrived = sent(change.message)
    try:
        return from_ros(BOARD, change.topic, arrived)
    except MessageError as error:
        text = str(error)
        assert '\n' not in text
        assert len(text) < 400
        return None


@pytest.mark.parametrize('topic', TOPICS, ids=lambda topic: topic.name)
def test_whatever_a_message_says_nothing_breaks(topic: Topic) -> None:
    """It is refused, or every part can live with it and the graph can carry it again."""
    refused = 0
    for change in changes(topic):
        heard = judge(change)
        if heard is None:
            refused += 1
        else:
            take_everywhere(heard)
    assert refused > 0


@pytest.mark.parametrize('topic', TOPICS, ids=lambda topic: topic.name)
@settings(max_examples=40)
@given(data=st.data())
def test_whatever_several_fields_say_nothing_breaks(topic: Topic, data: st.DataObject) -> None:
    chance = random.Random(data.draw(st.integers(0, 2**32)))
    message = example(topic)
    for _ in range(chance.randint(1, 4)):
        target, name, kind, path = chance.choice(list(fields(message)))
        value = getattr(target, name)
        setattr(
            target,
            name,
            chance.choice(values_of(kind) if '/' not in kind else changed_lists(value)),
        )
        message = deepcopy(message)
    heard = judge(Change(topic, path, None, message, name))
    if heard is not None:
        take_everywhere(heard)


def take_everywhere(heard: Any) -> None:
    """Let every part of a trial hear a message, early and late in the trial."""
    messages, record = said_in_example()
    for part in PARTS:
        for heard_before in (1, len(messages) // 2):
            memory = part.Memory()
            for message in messages[:heard_before]:
                memory, _ = part.step(memory, message)
            memory, said = part.step(memory, heard)
            for answer in said:
                if type(answer) in TOPIC_OF and TOPIC_OF[type(answer)] is not OUTCOME:
                    board = answer.spec.task.board if isinstance(answer, TrialStarted) else BOARD
                    serialize_message(to_ros(board, answer, record))
            if part is scribe and memory.trial is not None:
                serialize_message(outcome_to_ros('x', _ended(memory)))
                _ended(memory).to_line()


def _ended(memory: scribe.Memory) -> TrialRecord:
    ended, _ = scribe.step(memory, _cancel(memory))
    return ended.record()


def _cancel(memory: scribe.Memory) -> Message:
    assert memory.trial is not None
    return CancelTrial(memory.trial.trial_id)


@cache
def said_in_example() -> tuple[list[Message], TrialRecord]:
    """The trial that the examples are of."""
    return said_in(SPEC)


def _set(path: str, value: Any) -> Callable[[Any], None]:
    def change(message: Any) -> None:
        *owners, name = path.replace('[', '.').replace(']', '').split('.')
        for owner in owners:
            message = message[int(owner)] if owner.isdecimal() else getattr(message, owner)
        setattr(message, name, value)

    return change


def _drop_last(path: str) -> Callable[[Any], None]:
    return lambda message: _set(path, list(getattr(message, path))[:-1])(message)


PLACED = ros.Placement(block=ros.Block(width=1, height=2), column=0, row=3)
FREE_FALL = [PLACED]
REFUSED: list[tuple[str, Callable[[Any], None], str, str]] = [
    ('trial', _set('trial_id', ''), 'trial_id', "''"),
    *(
        (topic, _set(f'{field}.{side}', value), f'{field}.{side}', str(value))
        for topic, field in (
            ('trial', 'silhouette'),
            ('state', 'built'),
            ('search/request', 'region'),
            ('search/result', 'built'),
            ('plan', 'region'),
            ('subgoal', 'decisions[0].built'),
            ('subgoal', 'decisions[0].subgoals[0].region'),
        )
        for side in ('width', 'height')
        for value in (0, 17, 255)
    ),
    ('trial', _set('silhouette.cells', b'\1\1'), 'silhouette.cells', '2'),
    ('trial', _set('silhouette.cells', b'\2' * 24), 'silhouette.cells', '2'),
    ('state', _set('built', grid_to_ros(Board(5, 5), 0)), 'built', '5 x 5'),
    ('trial', _set('library', []), 'library', '0'),
    ('trial', _set('library', [ros.Block(width=1, height=1)] * 2), 'library', '1x1'),
    ('trial', _set('library[0].width', 0), 'library[0].width', '0'),
    ('trial', _set('library[1].height', 17), 'library[1].height', '17'),
    ('trial', _set('planner.strategy', 'luck'), 'planner.strategy', "'luck'"),
    ('trial', _set('planner.search', ''), 'planner.search', "''"),
    ('trial', _set('planner.commit', 'never'), 'commit', "'never'"),
    ('trial', _set('planner.divisor', 'mean'), 'planner.divisor', "'mean'"),
    ('trial', _set('planner.iterations', 9), 'planner.iterations', '9'),
    ('trial', _set('planner.depth', 0), 'depth', '0'),
    ('trial', _set('planner.depth', 65), 'depth', '65'),
    ('trial', _set('planner.lambda_weight', float('nan')), 'lambda', 'nan'),
    ('trial', _set('planner.lambda_weight', float('inf')), 'lambda', 'inf'),
    ('trial', _set('planner.lambda_weight', -0.5), 'lambda', '-0.5'),
    ('trial', _set('planner.budget', 2**63), 'budget', str(2**63)),
    ('state', _set('sequence', 0), 'sequence', '0'),
    ('state', _set('status', 'cancelled'), 'status', "'cancelled'"),
    ('state', _set('status', ''), 'status', "''"),
    ('state', _drop_last('placements'), 'sequence', ''),
    ('state', _set('placements', FREE_FALL), 'placements[0].row', '3'),
    ('state', _set('placements[0].column', 200), 'placements[0]', '200'),
    ('state', _set('placements[0].block.width', 0), 'placements[0].block.width', '0'),
    ('search/result', _set('status', 'cancelled'), 'status', "'cancelled'"),
    ('search/result', _set('status', 'budget_exhausted'), 'placements', ''),
    ('search/result', _drop_last('placements'), 'placements', ''),
    ('search/result', _set('placements', FREE_FALL), 'placements[0].row', '3'),
    ('search/request', _set('built.cells', b'\1' * 24), 'region', ''),
    ('plan', _set('placements[0].row', 200), 'placements[0]', '200'),
    ('action', _set('block.width', 0), 'block.width', '0'),
    ('action', _set('block.height', 17), 'block.height', '17'),
    ('action/outcome', _set('status', 'maybe'), 'status', "'maybe'"),
    ('action/outcome', _set('placed.column', 9), 'placed', '9'),
    ('outcome', _set('status', 'building'), 'status', "'building'"),
    ('subgoal/proposal', _set('sequence', 25), 'sequence', '25'),
    ('subgoal/proposal', _set('number', 1000), 'number', '1000'),
    ('subgoal/proposal', _set('kind', 'maybe'), 'kind', "'maybe'"),
    ('subgoal/proposal', _set('region.cells', b'\1'), 'region.cells', '1'),
    ('subgoal/proposal', _set('region', grid_to_ros(Board(5, 5), 0)), 'region', '5 x 5'),
    *(
        ('subgoal/proposal', _set('thinking_s', value), 'thinking_s', str(value))
        for value in (-1.0, float('nan'), float('inf'))
    ),
    ('trial', _set('planner.participant', 'Jane'), 'planner.participant', "'Jane'"),
    ('trial', _set('planner.costs', 'shown'), 'planner.costs', "'shown'"),
    ('subgoal', _set('decisions', []), 'decisions', '0'),
    ('subgoal', _set('status', 'none_solvable'), 'status', "'none_solvable'"),
    ('subgoal', _set('decisions[0].chosen', -2), 'decisions[0].chosen', '-2'),
    ('subgoal', _set('decisions[0].chosen', -1), 'decisions[0].chosen', '-1'),
    ('subgoal', _set('decisions[0].chosen', 99), 'decisions[0].chosen', '99'),
    ('subgoal', _set('decisions[0].executed', 0), 'decisions[0].executed', '0'),
    ('subgoal', _set('decisions[0].executed', 2), 'decisions[0].executed', '2'),
    ('subgoal', _set('decisions[0].candidates[0].value', float('nan')), 'value', 'nan'),
    ('subgoal', _set('decisions[0].candidates[0].value', float('-inf')), 'value', '-inf'),
    ('subgoal', _set('decisions[0].candidates[0].rows', b'\2\1'), 'rows', '[2, 1]'),
    ('subgoal', _set('decisions[0].candidates[0].rows', b'\x11'), 'rows', '[17]'),
    ('subgoal', _set('decisions[0].candidates[0].status', 'x'), 'candidates[0].status', "'x'"),
    ('subgoal', _set('decisions[0].subgoals[0].execute', 0), 'subgoals[0].execute', '0'),
    ('subgoal', _set('decisions[0].subgoals[0].execute', 99), 'subgoals[0].execute', '99'),
    ('subgoal', _set('decisions[0].subgoals[0].rows', 17), 'subgoals[0].rows', '17'),
    ('subgoal', _set('decisions[0].subgoals[0].placements', FREE_FALL), '.placements[0]', '3'),
    ('subgoal', _set('decisions[0].subgoals[0].placements', []), '.placements', '0'),
]


@pytest.mark.parametrize(
    ('name', 'change', 'field', 'value'),
    [pytest.param(*case, id=f'{case[0]}-{case[2]}-{case[3]}') for case in REFUSED],
)
def test_what_can_not_be_is_refused_by_field_and_value(
    name: str, change: Callable[[Any], None], field: str, value: str
) -> None:
    topic = next(topic for topic in TOPICS if topic.name == name)
    message = example(topic)
    from_ros(BOARD, topic, sent(message))
    change(message)
    with pytest.raises(MessageError) as refused:
        from_ros(BOARD, topic, sent(message))
    assert field in str(refused.value)
    assert value in str(refused.value)


def test_placements_that_overlap_are_refused() -> None:
    message = example(STATE)
    message.placements[1] = deepcopy(message.placements[0])
    with pytest.raises(MessageError, match=r'placements\[1\]\.row'):
        from_ros(BOARD, STATE, sent(message))


@pytest.mark.parametrize(
    ('name', 'path'),
    [
        ('search/result', 'planning_cost'),
        ('search/result', 'solution_cost'),
        ('subgoal', 'decisions[1].subgoal_planning_cost'),
        ('subgoal', 'decisions[0].candidates[0].planning_cost'),
        ('subgoal', 'decisions[0].subgoals[0].planning_cost'),
        ('subgoal', 'decisions[0].subgoals[0].solution_cost'),
    ],
)
def test_costs_that_no_sum_could_hold_are_refused(name: str, path: str) -> None:
    topic = next(topic for topic in TOPICS if topic.name == name)
    message = example(topic)
    _set(path, MAX_COST)(message)
    from_ros(BOARD, topic, sent(message))
    _set(path, 2**64 - 1)(message)
    with pytest.raises(MessageError, match=f'{re.escape(path)}.*{2**64 - 1}'):
        from_ros(BOARD, topic, sent(message))


def test_an_example_of_several_decisions() -> None:
    """What the fuzzing above changes has everything in it that can be changed."""
    heard = from_ros(BOARD, SUBGOAL, sent(example(SUBGOAL)))
    assert isinstance(heard, SubgoalChosen)
    assert len(heard.decisions) > 1
