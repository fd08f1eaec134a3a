"""The plug-in of the tutorial plans for a goal from another process, which does not have it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import yaml
from blocks_planning_msgs import msg
from blocks_planning_msgs.action import PlanTower
from blocks_planning_msgs.msg import TrialOutcome
from builders import spec
from graphs import NODES
from peers import Graph, Peer
from rclpy.action.client import ActionClient
from source_imports import ROOT
from test_docs import install_plug_in

from blocks_planning.search.searches import SEARCHES


def goal_of_page() -> Any:
    """The goal in the last listing of docs/plug_ins.md."""
    page = (ROOT / 'docs' / 'plug_ins.md').read_text(encoding='utf-8')
    text = page.rpartition('PlanTower "')[2].partition('"\n```')[0]
    return filled(PlanTower.Goal(), yaml.safe_load(text))


def filled(message: Any, values: dict[str, Any]) -> Any:
    """A message with the fields that a listing gives."""
    for name, value in values.items():
        kind = message.get_fields_and_field_types()[name].rstrip('>').rpartition('/')[2]
        if isinstance(value, dict):
            filled(getattr(message, name), value)
        elif isinstance(value, list) and isinstance(value[0], dict):
            setattr(message, name, [filled(getattr(msg, kind)(), item) for item in value])
        else:
            setattr(message, name, value)
    return message


def test_goal_of_the_tutorial_is_planned(graph: Graph, tmp_path: Path) -> None:
    install_plug_in(tmp_path)
    assert 'largest_first' not in SEARCHES
    environment = {**os.environ, 'PYTHONPATH': f'{tmp_path}{os.pathsep}{ROOT}'}
    command = [sys.executable, '-m', NODES, 'action_searcher']
    searcher = subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL)
    try:
        client = ActionClient(
            graph.add(Peer, spec(), (), (), namespace=''), PlanTower, 'plan_tower'
        )
        graph.spin_until(client.server_is_ready)
        sending = client.send_goal_async(goal_of_page())
        graph.spin_until(sending.done)
        ending = sending.result().get_result_async()
        graph.spin_until(ending.done)
    finally:
        searcher.terminate()
        searcher.wait(10)
    plan = ending.result().result
    assert plan.code == TrialOutcome.CODE_SUCCESS, plan.reason
    assert len(plan.placements) == 3
