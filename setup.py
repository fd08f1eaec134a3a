"""Package metadata and what is installed where, for pip and for colcon (ament_python)."""

import re
from pathlib import Path

from setuptools import find_packages, setup

NAME = 'blocks_planning'
SHARE = f'share/{NAME}'
NODES = (
    *('world', 'subgoal_selector', 'action_searcher', 'trial_orchestrator', 'bag_recorder'),
    'marker_publisher',
    'trial_view',
    'robot_arm',
)

# What planning and the nodes do without. blocks_planning/extras.py names the extra where a module
# of it is missing.
EXTRAS = {
    'experiments': [
        'distributed>=2022.12.1',
        'joblib>=1.3.2',
        'pandas>=2.1.4',
        'pyarrow>=14',
        'scipy>=1.11.4',
    ],
    'figures': ['jinja2>=3.1.2', 'matplotlib>=3.6.3', 'pillow>=10.2'],
    'page': ['aiohttp>=3.9.1'],
}


def version() -> str:
    """Read the version where it is defined, without importing the package."""
    source = Path(NAME, '__init__.py').read_text(encoding='utf-8')
    found = re.search(r"^__version__ = '([^']+)'$", source, re.MULTILINE)
    if found is None:
        raise SystemExit(f"{NAME}/__init__.py has no line like __version__ = '1.2.3'")
    return found.group(1)


def shared(folder: str) -> list[tuple[str, list[str]]]:
    """List all files under `folder`, each to be installed at the same place under share/."""
    found = (path for path in Path(folder).rglob('*') if path.is_file())
    files = sorted(path for path in found if '__pycache__' not in path.parts)
    places = sorted({path.parent for path in files})
    return [
        (f'{SHARE}/{place.as_posix()}', [str(path) for path in files if path.parent == place])
        for place in places
    ]


setup(
    name=NAME,
    version=version(),
    description='Block-tower reconstruction with visual scoping: planners, trials and ROS 2 nodes',
    long_description=Path('README.md').read_text(encoding='utf-8'),
    long_description_content_type='text/markdown',
    license='Apache-2.0',
    license_files=['LICENSE'],
    maintainer='blocks_planning maintainers',
    maintainer_email='maintainers@blocks-planning.example',
    classifiers=[
        'Intended Audience :: Science/Research',
        'Operating System :: OS Independent',
        'Programming Language :: Python :: 3 :: Only',
        'Topic :: Scientific/Engineering',
        'Typing :: Typed',
    ],
    python_requires='>=3.10',
    packages=find_packages(include=[NAME, f'{NAME}.*']),
    package_data={
        NAME: [
            'py.typed',
            'analysis/paper.yaml',
            'analysis/templates/*.html',
            'view/study/static/*',
            'view/web/static/*',
        ]
    },
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (SHARE, ['package.xml']),
        *shared('stimuli'),
        *shared('config'),
        *shared('launch'),
    ],
    # The floors are what Ubuntu 24.04 ships beside ROS 2 Jazzy. What ROS itself brings is
    # named in package.xml only: there is no distribution called rclpy.
    install_requires=[
        'PyYAML>=6.0.1',
        'click>=8.1.6',
        'mcap>=1.6',  # no distribution of Linux has it, nor rosbags
        'numba>=0.58.1',
        'numpy>=1.26.4',
        'portalocker>=2.7',
        'rich>=13.7.1',
        'rosbags>=0.11',
    ],
    extras_require={
        **EXTRAS,
        'all': sorted(name for names in EXTRAS.values() for name in names),
        'test': [
            'axe-playwright-python>=0.1.4',
            'hypothesis>=6.98',
            'mcap-ros2-support>=0.6',
            'playwright>=1.40',
            'pytest>=7.4.4',
        ],
        'robot': ['mujoco>=3.17,<4'],  # a body in simulation; not in `all`
    },
    entry_points={
        'console_scripts': [
            'blocks-planning = blocks_planning.cli:main',
            *(f'{node} = {NAME}.ros.executables:{node}' for node in NODES),
        ]
    },
    zip_safe=False,
)
