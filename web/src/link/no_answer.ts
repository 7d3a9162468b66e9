// web/src/link/no_answer.ts: the failure of a call whose answer is late. The server may have carried it out.

export class NoAnswer extends Error {}
