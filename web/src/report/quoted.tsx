/** Shows the parts of a sentence between backticks as code. */
export function Quoted({ sentence }: { sentence: string }) {
  return <>{sentence.split("`").map((part, i) => (i % 2 === 1 ? <code key={i}>{part}</code> : part))}</>;
}
