// The experimenter's page: it asks once a second how the study stands.

import { byId, html, say, whenNew } from './dom.js';

const PERIOD_MS = 1000;
let suggested = null;

async function ask(path, code) {
  const options = code === undefined ? {} : {
    method: 'POST',
    headers: { 'Content-Type': 'application/json' },
    body: JSON.stringify({ code }),
  };
  try {
    const answer = await fetch(`/experimenter/${path}`, options);
    const said = await answer.json();
    if (!answer.ok) return { reason: said.reason };
    show(said);
    return {};
  } catch {
    showLink('lost', 'connection lost, trying again');
    return { reason: 'the connection is lost' };
  }
}

function showLink(state, text) {
  byId('connection').dataset.state = state;
  document.body.dataset.link = state;
  say(byId('connection-text'), text);
}

function show(state) {
  showLink('live', 'live');
  say(byId('title'), state.title);
  document.title = `Experimenter: ${state.title}`;
  say(byId('current'), state.current ?? 'nobody');
  say(byId('doing'), state.doing || '–');
  say(byId('since'), state.on_step_s === null ? '–' : `${state.on_step_s} s`);
  say(byId('has-page'), state.has_page ? 'connected' : 'not connected');
  say(byId('free'), `${(state.free_bytes / 2 ** 30).toFixed(1)} GiB`);
  say(byId('folder'), state.folder);
  byId('begin').querySelector('.primary').disabled = !state.may_begin;
  byId('close').disabled = state.may_begin;
  if (suggested !== state.suggested) {
    suggested = state.suggested;
    byId('code').value = suggested;
  }
  byId('banner').hidden = state.trouble === '';
  say(byId('banner'), state.trouble);
  showAll(state.participants.map((one) => ({ ...one, may_reopen: one.may_reopen && state.may_begin })));
}

const showAll = whenNew((participants) => byId('all').replaceChildren(
  ...participants.toReversed().map((one) => {
    const reopen = html('button', { type: 'button', class: 'small', 'aria-label': `Open ${one.code} again` }, 'Open again');
    reopen.addEventListener('click', () => command('reopen', one.code));
    return html('tr', {},
      html('th', { scope: 'row' }, one.code),
      html('td', { class: 'number' }, String(one.number)),
      html('td', {}, one.status),
      html('td', { class: 'number' }, `${one.step} of ${one.steps}`),
      html('td', {}, one.last_at.replace('T', ' ').slice(0, 19)),
      html('td', {}, one.may_reopen ? reopen : ''));
  })));

async function command(path, code) {
  const { reason } = await ask(path, code);
  say(byId('said'), reason ?? '');
}

byId('begin').addEventListener('submit', (event) => {
  event.preventDefault();
  command('begin', byId('code').value);
});
byId('close').addEventListener('click', () => command('close', ''));

async function watch() {
  const { reason } = await ask('state');
  if (reason) showLink('lost', reason);
  setTimeout(watch, PERIOD_MS);
}
watch();
